#pragma once
// The command line of certify as values.

#include <cstdint>
#include <optional>
#include <string>

#include "common/mwis/exact_algorithm.hpp"

namespace hexpipe::certify {

struct CertifyOptions {
  std::optional<mwis::ExactAlgorithm> exact{};  // go on to a proof of optimality
  std::optional<std::int64_t> passes{};         // of the dual; nothing: as many as usually pay off
  std::string certificate{};                    // a file for the proof of the bound; empty: no such file
};

}  // namespace hexpipe::certify
