#pragma once
// The command line of viewmesh as values.

#include <string>
#include <vector>

namespace hexpipe::viewmesh {

struct ViewmeshOptions {
  std::string page, picture;          // files; without both, the page goes to standard output
  std::vector<int> size{1600, 1000};  // of the picture, in pixels
  std::string show;                   // a Scene::Content by name; empty: the last one in the input
  std::string view;                   // as parse_view_state reads it
  std::string fragments;              // a file of fragments; empty: no such file
  std::string title;                  // of the page; empty: the name of its content
};

// Throws UsageError where a name's ending belongs to the other kind of output, or the page would go to a terminal.
void check(const ViewmeshOptions& options);

}  // namespace hexpipe::viewmesh
