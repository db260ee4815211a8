#pragma once
// Sets of numbers that are joined, under the name that they have here.

#include "common/mesh/joined_sets.hpp"

namespace hexpipe::tetmesh::geometry {

using hexpipe::JoinedSets;

}  // namespace hexpipe::tetmesh::geometry
