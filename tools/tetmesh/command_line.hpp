#pragma once
// What of tetmesh's command line no single option tells.

#include <functional>
#include <string>
#include <vector>

#include "tools/tetmesh/tetmesh.hpp"

namespace hexpipe::tetmesh {

// The words of a command line for CLI11, which takes the word behind an option for its optional value, whatever it is:
// one behind --layers or --tags-by-angle that is no number is the surface. Words stay those of argv, or last as long as
// the process.
std::vector<char*> words_for_parsing(int argc, char** argv);

// Throws UsageError where an option was given that does nothing beside the others: whoever gives one expects it to.
// `is_given` tells of an option, by its name, `points` is the value of --points.
void refuse_idle_options(const std::function<bool(const char*)>& is_given, const TetmeshOptions& options,
                         const std::string& points);

}  // namespace hexpipe::tetmesh
