#pragma once
// Reads a part's bundle once from front to back, side by side with the others.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/run/progress.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/streams/input.hpp"

namespace hexpipe::merge_parts {

class PartReader {
 public:
  // Goes to the first member. Throws DataError when the file is not a bundle.
  explicit PartReader(const std::string& path);

  pipeline::BundleReader& bundle() { return *reader_; }
  // Whether there is a member to read; name() is its name.
  bool at_member() const { return at_member_; }
  const std::string& name() const { return reader_->name(); }
  void next();
  // Counts bytes of the member at hand as read; next() counts the rest.
  void count(std::uint64_t bytes);
  // Bytes are counted in this step, which lives at least as long.
  void show_in(Step& step) { step_ = &step; }
  const std::string& bundle_name() const { return input_->name(); }

 private:
  // On the heap, as the reader holds its address.
  std::unique_ptr<formats::Input> input_;
  std::unique_ptr<pipeline::BundleReader> reader_;
  bool at_member_ = false;
  Step* step_ = nullptr;  // none: nobody counts
  std::uint64_t counted_ = 0;
};

using PartReaders = std::vector<PartReader>;

// The name of the member at which all parts stand; empty at the end. Throws DataError when they differ.
std::string common_member(const PartReaders& parts);
void next(PartReaders& parts);
// Copies the member at which all stand. Throws DataError when it is not the same in all.
void copy_common(PartReaders& parts, pipeline::BundleWriter& out);

}  // namespace hexpipe::merge_parts
