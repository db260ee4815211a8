#include "tools/merge-parts/part_reader.hpp"

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

}  // namespace hexpipe::merge_parts
