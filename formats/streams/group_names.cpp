#include "formats/streams/group_names.hpp"

#include <charconv>
#include <nlohmann/json.hpp>
#include <system_error>

#include "common/run/error.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

using Names = std::map<std::int32_t, std::string>;

// How many bytes the character that begins there has, 0 where it is no UTF-8.
std::size_t utf8_length(std::string_view bytes) {
  const auto at = [&](std::size_t i) { return static_cast<unsigned char>(bytes[i]); };
  const unsigned char first = at(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || bytes.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((at(i) & 0xc0) != 0x80) return 0;
  // Not the shortest way to write it, a surrogate, or beyond the last character.
  const bool wrong = (first == 0xe0 && at(1) < 0xa0) || (first == 0xed && at(1) >= 0xa0) ||
                     (first == 0xf0 && at(1) < 0x90) || (first == 0xf4 && at(1) >= 0x90);
  return wrong ? 0 : length;
}

bool is_utf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    if (length == 0) return false;
    bytes.remove_prefix(length);
  }
  return true;
}

std::string from_latin1(std::string_view bytes) {
  std::string text;
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      text += c;
    } else {
      text += static_cast<char>(0xc0 | (byte >> 6));
      text += static_cast<char>(0x80 | (byte & 0x3f));
    }
  }
  return text;
}

std::int32_t tag_of(const std::string& key, const std::string& where) {
  std::int32_t tag = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), tag);
  if (error != std::errc() || end != key.data() + key.size())
    throw DataError::at(where, "expected the number of a tag, found {}", key.empty() ? "''" : quote_found(key));
  return tag;
}

Names parse_names(const nlohmann::json& object, const char* kind, const std::string& where) {
  Names names;
  const auto found = object.find(kind);
  if (found == object.end()) return names;
  if (!found->is_object()) throw DataError::at(where, "expected \"{}\" as an object, found something else", kind);
  for (const auto& [key, value] : found->items()) {
    if (!value.is_string() || value.get_ref<const std::string&>().empty())
      throw DataError::at(where, "expected a name for tag {} of \"{}\", found {}", quote_found(key), kind,
                          value.is_string() ? "an empty one" : "something else");
    names[tag_of(key, where)] = value.get<std::string>();
  }
  return names;
}

}  // namespace

std::string clean_name(std::string_view bytes) {
  std::string name = is_utf8(bytes) ? std::string(bytes) : from_latin1(bytes);
  for (char& c : name)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  const std::size_t first = name.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return name.substr(first, name.find_last_not_of(' ') + 1 - first);
}

GroupNames parse_group_names(const std::string& text, const std::string& where) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object())
    throw DataError::at(where, "expected a JSON object with the names of surfaces, regions and curves, found {}",
                        json.is_discarded() ? "no JSON" : "something else");
  return {parse_names(json, "surfaces", where), parse_names(json, "regions", where),
          parse_names(json, "curves", where)};
}

std::string text_of(const GroupNames& names) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  const auto add = [&](const char* kind, const Names& of_kind) {
    if (of_kind.empty()) return;
    nlohmann::ordered_json object = nlohmann::ordered_json::object();
    for (const auto& [tag, name] : of_kind) object[std::to_string(tag)] = name;
    json[kind] = std::move(object);
  };
  add("surfaces", names.surfaces);
  add("regions", names.regions);
  add("curves", names.curves);
  return json.dump() + "\n";
}

}  // namespace hexpipe::formats
