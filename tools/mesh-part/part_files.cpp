#include "tools/mesh-part/part_files.hpp"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "common/run/error.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/members.hpp"

namespace hexpipe::mesh_part {
namespace {

constexpr std::string_view stem = "part-";

// 12 for "part-0012.tar"; nothing for other names.
std::optional<std::int32_t> number_in(std::string_view name) {
  if (!name.starts_with(stem)) return std::nullopt;
  name.remove_prefix(stem.size());
  std::int32_t number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  const std::string_view ending(end, static_cast<std::size_t>(name.data() + name.size() - end));
  const bool is_part = error == std::errc() && number >= 0 && (ending == ".tar" || ending == ".tar.zst");
  return is_part ? std::optional(number) : std::nullopt;
}

}  // namespace

PartFiles::PartFiles(std::string directory, std::int32_t parts, bool compress)
    : directory_(std::move(directory)), compress_(compress) {
  files_.make_directory(directory_);
  std::error_code error;
  for (auto entry = std::filesystem::directory_iterator(directory_, error);
       !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    const std::optional<std::int32_t> number = number_in(name);
    if (number && (*number >= parts || name != name_of(*number)))
      throw DataError::at(directory_, "expected no parts but the {} to be written, found {}: remove it", parts, name);
  }
  if (error) throw DataError::at(directory_, "cannot list the directory: {}", error.message());
}

std::string PartFiles::name_of(std::int32_t part) const {
  return fmt::format("{}{:04}.tar{}", stem, part, compress_ ? ".zst" : "");
}

void PartFiles::write(const PartOfMesh& part, const SharedMembers& shared) {
  formats::Output& output = files_.add(fmt::format("{}/{}", directory_, name_of(part.part.part)));
  pipeline::BundleWriter writer(output, compress_);
  pipeline::write_members(writer, part.part);
  for (const pipeline::RawMember& member : shared.surface) writer.add_text(member.name, member.bytes);
  pipeline::write_members(writer, part.mesh);
  if (!shared.dislocations.empty()) pipeline::write_dislocations(writer, shared.dislocations);
  if (!shared.names.empty()) writer.add_text(std::string(formats::names_member), text_of(shared.names));
  pipeline::write_history(writer, shared.history);
  writer.close();
  output.drain();
}

}  // namespace hexpipe::mesh_part
