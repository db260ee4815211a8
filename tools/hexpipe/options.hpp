#pragma once
// The options of hexpipe.

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace hexpipe::front_door {

// How much time the choice of hexes gets.
enum class Effort { quick, usual, thorough };

struct PipeOptions {
  std::string input;                         // a surface or CAD; empty: the pipe starts after it
  std::optional<std::string> mesh;           // tets of another program, in place of a surface
  std::string output;                        // the result, in the format that the ending names
  std::optional<std::string> page, picture;  // of viewmesh
  std::optional<std::string> keep;           // folder that keeps the product of each stage
  std::optional<std::string> from;           // product in that folder to go on from
  std::optional<std::string> size;           // of tetmesh
  std::optional<std::string> solver;         // of assemble: whom the result is for
  Effort effort = Effort::usual;
  std::optional<int> threads;
  std::optional<std::uint64_t> seed;
  std::map<std::string, std::string> stage_options;  // by tool: more options, in a shell's syntax
};

}  // namespace hexpipe::front_door
