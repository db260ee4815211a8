#include "tools/merge-parts/part_reader.hpp"

#include <algorithm>
#include <array>

#include "common/run/error.hpp"

namespace hexpipe::merge_parts {
namespace {

std::string standing_at(const PartReader& part) {
  return part.at_member() ? part.name() : std::string();
}

}  // namespace

PartReader::PartReader(const std::string& path) : input_(std::make_unique<formats::Input>(formats::Input::open(path))) {
  if (!pipeline::looks_like_bundle(*input_))
    throw DataError::at(path, "expected a bundle of a part, found another file");
  reader_ = std::make_unique<pipeline::BundleReader>(*input_);
  next();
}

void PartReader::count(std::uint64_t bytes) {
  counted_ += bytes;
  if (step_) step_->advance(static_cast<std::int64_t>(bytes));
}

void PartReader::next() {
  if (at_member_ && counted_ < reader_->size()) count(reader_->size() - counted_);
  counted_ = 0;
  at_member_ = reader_->next();
}

std::string common_member(const PartReaders& parts) {
  const std::string first = standing_at(parts.front());
  for (const PartReader& part : parts)
    if (const std::string other = standing_at(part); other != first)
      throw DataError::at(part.bundle_name(), "expected {} as in {}, found {}", first.empty() ? "its end" : first,
                          parts.front().bundle_name(), other.empty() ? "its end" : other);
  return first;
}

void next(PartReaders& parts) {
  for (PartReader& part : parts) part.next();
}

void copy_common(PartReaders& parts, pipeline::BundleWriter& out) {
  constexpr std::size_t block = 64 << 10;
  pipeline::BundleReader& first = parts.front().bundle();
  const auto fail = [](PartReader& part) {
    throw DataError::at(part.bundle().where(), "expected the same as in the first bundle, found other bytes");
  };
  for (PartReader& part : parts)
    if (part.bundle().size() != first.size()) fail(part);
  out.begin_member(first.name(), first.size());
  std::array<char, block> bytes{}, others{};
  while (const std::size_t count = first.read_some(bytes.data(), block)) {
    for (std::size_t p = 1; p < parts.size(); ++p) {
      parts[p].bundle().read_some(others.data(), count);
      if (!std::equal(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(count), bytes.begin()))
        fail(parts[p]);
    }
    out.write(bytes.data(), count);
  }
}

}  // namespace hexpipe::merge_parts
