#include "formats/history.hpp"

#include <fmt/format.h>

#include <utility>

#include "common/run/error.hpp"
#include "common/run/version.hpp"

namespace hexpipe {
namespace {

constexpr std::string_view folder = "history/";
constexpr std::size_t longest_entry = 1 << 20;

}  // namespace

bool is_history_entry(std::string_view member) {
  return member.starts_with(folder);
}

nlohmann::ordered_json history_entry_of(const RunContext& context) {
  return {{"tool", context.info.name}, {"version", version()}, {"options", context.options}};
}

nlohmann::ordered_json read_history_entry(BundleReader& reader, std::string* text) {
  std::string read = reader.read_text(longest_entry);
  auto entry = nlohmann::ordered_json::parse(read, nullptr, false);
  if (!entry.is_object() || (entry.contains("tool") && !entry["tool"].is_string()))
    throw DataError::at(reader.where(), "expected a JSON object with the name of a tool, found something else");
  if (entry.contains("version") && !entry["version"].is_string())
    throw DataError::at(reader.where(), "expected a version that is text, found something else");
  if (entry.contains("options") && !entry["options"].is_object())
    throw DataError::at(reader.where(), "expected options as a JSON object, found something else");
  if (text) *text = std::move(read);
  return entry;
}

std::string tool_of(const nlohmann::ordered_json& entry) {
  return entry.value("tool", "stage");
}

std::string history_member(int number, const nlohmann::ordered_json& entry) {
  return fmt::format("{}{:02}-{}.json", folder, number, tool_of(entry));
}

void write_history_entry(BundleWriter& writer, const std::string& member, const nlohmann::ordered_json& entry) {
  writer.add_text(member, entry.dump(2) + "\n");
}

void write_history(BundleWriter& writer, const std::vector<nlohmann::ordered_json>& history) {
  int number = 0;
  for (const auto& entry : history) write_history_entry(writer, history_member(++number, entry), entry);
}

nlohmann::ordered_json settings_of(const std::string& tool, const std::vector<nlohmann::ordered_json>& history) {
  for (auto entry = history.rbegin(); entry != history.rend(); ++entry)
    if (tool_of(*entry) == tool)
      return {{"version", entry->value("version", "")},
              {"options", entry->value("options", nlohmann::ordered_json::object())}};
  return nullptr;
}

}  // namespace hexpipe
