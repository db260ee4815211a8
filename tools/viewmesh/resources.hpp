#pragma once
// The files of page/, which the build puts into the executable.

#include <string_view>

namespace hexpipe::resources {

extern const std::string_view page;         // index.html, with places for the others
extern const std::string_view style;        // style.css
extern const std::string_view script;       // main.js with all that it imports, three.js among it
extern const std::string_view colours;      // colours.json
extern const std::string_view skin_vertex;  // skin.vert and so on
extern const std::string_view skin_fragment;
extern const std::string_view screen_vertex;
extern const std::string_view occlusion_fragment;
extern const std::string_view line_vertex;
extern const std::string_view line_fragment;
extern const std::string_view font;  // DejaVu Sans, TrueType

}  // namespace hexpipe::resources
