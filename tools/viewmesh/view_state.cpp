#include "tools/viewmesh/view_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include "common/run/error.hpp"

namespace hexpipe::viewmesh {
namespace {

constexpr std::array colour_names{"hexes",         "quality", "kind",        "region",  "surface",
                                  "orthogonality", "weight",  "determinant", "flatness"};
constexpr std::array group_kinds{"region", "surface"};
constexpr std::array axis_names{"x", "y", "z"};
constexpr std::array axes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

[[noreturn]] void fail(std::string_view key, std::string_view expected, std::string_view found) {
  throw UsageError(fmt::format("--view: {}: expected {}, found '{}'", key, expected, found));
}

// Empty text gives one empty part: a separator too many is refused like any other wrong part.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end; (end = text.find(separator)) != std::string_view::npos; text.remove_prefix(end + 1))
    parts.push_back(text.substr(0, end));
  parts.push_back(text);
  return parts;
}

double parse_number(std::string_view key, std::string_view text, double low, double high) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value <= high))
    fail(key, fmt::format("a number from {:g} to {:g}", low, high), text);
  return value;
}

std::vector<double> parse_numbers(std::string_view key, std::string_view text, std::size_t count, double low,
                                  double high) {
  std::vector<double> numbers;
  const auto parts = split(text, ',');
  if (parts.size() != count) fail(key, fmt::format("{} numbers joined by commas", count), text);
  for (const auto part : parts) numbers.push_back(parse_number(key, part, low, high));
  return numbers;
}

template <std::size_t N>
std::size_t parse_name(std::string_view key, std::string_view text, const std::array<const char*, N>& names) {
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) fail(key, fmt::format("one of {}", fmt::join(names, ", ")), text);
  return static_cast<std::size_t>(found - names.begin());
}

Vec3 parse_direction(std::string_view key, std::string_view text) {
  const bool turned = text.starts_with('-');
  const auto axis = std::find(axis_names.begin(), axis_names.end(), text.substr(turned ? 1 : 0));
  if (axis != axis_names.end()) return (turned ? -1.0 : 1.0) * axes[axis - axis_names.begin()];
  const auto numbers = parse_numbers(key, text, 3, -1, 1);
  const Vec3 direction{numbers[0], numbers[1], numbers[2]};
  if (norm(direction) < 1e-3) fail(key, "a direction", text);
  return direction;
}

std::optional<ViewState::Clip> parse_clip(std::string_view text) {
  if (text == "none") return std::nullopt;
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) fail("clip", "AXIS:FRACTION or none", text);
  return ViewState::Clip{parse_direction("clip", text.substr(0, colon)),
                         parse_number("clip", text.substr(colon + 1), 0, 1)};
}

std::array<bool, 4> parse_kinds(std::string_view text) {
  std::array<bool, 4> kinds{};
  std::array<const char*, 4> names{};
  std::transform(scene_kinds.begin(), scene_kinds.end(), names.begin(), [](CellKind kind) { return name_of(kind); });
  if (text == "none") return kinds;
  if (text.empty()) fail("kinds", fmt::format("none or some of {}", fmt::join(names, ", ")), text);
  for (const auto part : split(text, ',')) kinds[parse_name("kinds", part, names)] = true;
  return kinds;
}

std::vector<ViewState::HiddenGroup> parse_hidden(std::string_view text) {
  std::vector<ViewState::HiddenGroup> hidden;
  if (text == "none") return hidden;
  for (const auto part : split(text, ',')) {
    const std::size_t colon = part.find(':');
    if (colon == std::string_view::npos || colon + 1 == part.size())
      fail("hidden", "none, or region:NAME or surface:NAME (a name or a number) joined by commas", part);
    const auto kind =
        static_cast<ViewState::HiddenGroup::Kind>(parse_name("hidden", part.substr(0, colon), group_kinds));
    const auto word = part.substr(colon + 1);
    std::int32_t tag = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), tag);
    const bool number = error == std::errc() && end == word.data() + word.size();
    hidden.push_back({kind, number ? std::optional(tag) : std::nullopt, std::string(word)});
  }
  return hidden;
}

std::string hidden_text(const std::vector<ViewState::HiddenGroup>& hidden) {
  std::vector<std::string> words;
  for (const auto& group : hidden)
    words.push_back(fmt::format("{}:{}", group_kinds[static_cast<int>(group.kind)],
                                group.tag ? std::to_string(*group.tag) : group.name));
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ","));
}

std::string direction_text(const Vec3& direction) {
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (direction == axes[i]) return axis_names[i];
    if (direction == -axes[i]) return fmt::format("-{}", axis_names[i]);
  }
  return fmt::format("{:g},{:g},{:g}", direction.x, direction.y, direction.z);
}

std::string kinds_text(const std::array<bool, 4>& kinds) {
  std::vector<const char*> names;
  for (std::size_t k = 0; k < kinds.size(); ++k)
    if (kinds[k]) names.push_back(name_of(scene_kinds[k]));
  return names.empty() ? "none" : fmt::format("{}", fmt::join(names, ","));
}

bool parse_switch(std::string_view key, std::string_view text) {
  return parse_name(key, text, std::array{"off", "on"}) == 1;
}

// Two angles alone leave zoom and target to what is shown.
void set_camera(ViewState& state, std::string_view text) {
  const auto count = std::ranges::count(text, ',');
  if (count != 1 && count != 5) fail("camera", "2 or 6 numbers joined by commas", text);
  const auto numbers = parse_numbers("camera", text, static_cast<std::size_t>(count) + 1, -1e4, 1e4);
  state.fitted = count == 1;
  state.azimuth = numbers[0], state.elevation = numbers[1];
  if (std::abs(state.elevation) > 90) fail("camera", "an elevation from -90 to 90", text);
  if (state.fitted) return;
  state.zoom = numbers[2], state.target = {numbers[3], numbers[4], numbers[5]};
  if (state.zoom < 0.05) fail("camera", "a zoom from 0.05", text);
}

ViewState::Up parse_up(std::string_view text) {
  const bool turned = text.starts_with('-');
  const auto axis = std::ranges::find(axis_names, text.substr(turned ? 1 : 0));
  if (axis == axis_names.end()) fail("up", "one of x, y, z, -x, -y, -z", text);
  return {static_cast<int>(axis - axis_names.begin()), turned};
}

std::string camera_text(const ViewState& state) {
  const std::string angles = fmt::format("{:g},{:g}", state.azimuth, state.elevation);
  if (state.fitted) return angles;
  return fmt::format("{},{:g},{:g},{:g},{:g}", angles, state.zoom, state.target.x, state.target.y, state.target.z);
}

const char* switch_text(bool on) {
  return on ? "on" : "off";
}

// The setter of each key.
std::map<std::string_view, std::function<void(std::string_view)>> setters_of(ViewState& state) {
  const auto set_colour = [&](std::string_view text) {
    state.colour = static_cast<ViewState::Colour>(parse_name("colour", text, colour_names));
  };
  return {
      {"camera", [&](std::string_view text) { set_camera(state, text); }},
      {"up", [&](std::string_view text) { state.up = parse_up(text); }},
      {"clip", [&](std::string_view text) { state.clip = parse_clip(text); }},
      {"quality",
       [&](std::string_view text) {
         const auto range = parse_numbers("quality", text, 2, -1, 1);
         state.least_quality = range[0], state.greatest_quality = range[1];
       }},
      {"peel", [&](std::string_view text) { state.peel = static_cast<int>(parse_number("peel", text, 0, 255)); }},
      {"kinds", [&](std::string_view text) { state.kinds = parse_kinds(text); }},
      {"colour", set_colour},
      {"color", set_colour},
      {"hidden", [&](std::string_view text) { state.hidden = parse_hidden(text); }},
      {"edges", [&](std::string_view text) { state.edges = parse_switch("edges", text); }},
      {"axes", [&](std::string_view text) { state.axes = parse_switch("axes", text); }},
      {"legend", [&](std::string_view text) { state.legend = parse_switch("legend", text); }},
      {"dislocations", [&](std::string_view text) { state.dislocations = parse_switch("dislocations", text); }},
      {"theme",
       [&](std::string_view text) {
         state.dark = parse_name("theme", text, std::array{"light", "dark"}) == 1;
       }},
      {"fragment",
       [&](std::string_view text) { state.fragment = static_cast<int>(parse_number("fragment", text, 0, 1e9)); }},
  };
}

}  // namespace

ViewState parse_view_state(std::string_view text) {
  ViewState state;
  if (text.empty()) return state;
  const auto setters = setters_of(state);
  for (const auto part : split(text, '&')) {
    const std::size_t equals = std::min(part.find('='), part.size());
    const auto setter = setters.find(part.substr(0, equals));
    if (setter == setters.end()) {
      std::vector<std::string_view> names;
      names.reserve(setters.size());
      for (const auto& [name, set] : setters) names.push_back(name);
      throw UsageError(
          fmt::format("--view: expected KEY=VALUE with a key of {}, found '{}'", fmt::join(names, ", "), part));
    }
    setter->second(part.substr(std::min(equals + 1, part.size())));
  }
  return state;
}

std::string to_text(const ViewState& state) {
  return fmt::format(
      "camera={}&up={}{}&clip={}&quality={:g},{:g}&peel={}&kinds={}&hidden={}&colour={}"
      "&edges={}&axes={}&legend={}&dislocations={}&theme={}&fragment={}",
      camera_text(state), state.up.turned ? "-" : "", axis_names[state.up.axis],
      state.clip ? fmt::format("{}:{:g}", direction_text(state.clip->normal), state.clip->fraction) : "none",
      state.least_quality, state.greatest_quality, state.peel, kinds_text(state.kinds), hidden_text(state.hidden),
      colour_names[static_cast<int>(state.colour)], switch_text(state.edges), switch_text(state.axes),
      switch_text(state.legend), switch_text(state.dislocations), state.dark ? "dark" : "light", state.fragment);
}

void resolve_groups(ViewState& state, const Scene& scene) {
  for (auto& hidden : state.hidden) {
    const auto& groups = hidden.kind == ViewState::HiddenGroup::Kind::region ? scene.regions : scene.surfaces;
    const auto fits = [&](const Group& group) {
      return hidden.tag ? group.tag == *hidden.tag : group.name == hidden.name;
    };
    const auto found = std::find_if(groups.begin(), groups.end(), fits);
    if (found == groups.end()) {
      std::vector<std::string> names;
      for (const Group& group : groups) names.push_back(group.name);
      const std::string kind = group_kinds[static_cast<int>(hidden.kind)];
      fail("hidden",
           groups.empty() ? fmt::format("no {}, because there is none", kind)
                          : fmt::format("a {} of {}", kind, fmt::join(names, ", ")),
           hidden.name);
    }
    hidden.tag = found->tag;
  }
}

std::optional<std::size_t> measure_of(ViewState::Colour colour) {
  const auto place = static_cast<int>(colour) - static_cast<int>(ViewState::Colour::orthogonality);
  return place < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(place));
}

void check_colour(const ViewState& state, const Scene& scene) {
  if (const auto measure = measure_of(state.colour); measure && scene.measures[*measure].empty())
    fail("colour", fmt::format("one of the first five for {}, because its cells are no mesh", name_of(scene.content)),
         measure_names[*measure]);
}

}  // namespace hexpipe::viewmesh
