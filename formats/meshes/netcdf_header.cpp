#include "formats/meshes/netcdf_header.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/run/error.hpp"

namespace hexpipe::formats {
namespace {

using namespace std::string_view_literals;

// Bytes of a value, by type from 1: byte, char, short, int, float, double, and those of CDF-5.
constexpr std::array<std::uint64_t, 12> bytes_of_type{0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};

std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_mul_overflow(a, b, &result) ? std::numeric_limits<std::uint64_t>::max() : result;
}

// As the specification of the format has it, list by list.
class HeaderCheck {
 public:
  HeaderCheck(std::string_view bytes, const std::string& name)
      : bytes_(bytes), name_(name), wide_counts_(bytes[3] == 5), wide_offsets_(bytes[3] != 1) {}

  void run() {
    at_ = 4;
    count();  // of records
    list(10, [&] {
      text();
      lengths_.push_back(count());
    });
    attributes();
    list(11, [&] { variable(); });
  }

 private:
  [[noreturn]] void fail() const {
    throw DataError::at(name_, "expected NetCDF's header to fit its data, found a damaged or cut off one");
  }

  std::uint64_t number(std::size_t size) {
    if (bytes_.size() - at_ < size) fail();
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes_[at_++]);
    return value;
  }
  std::uint64_t count() { return number(wide_counts_ ? 8 : 4); }

  void skip(std::uint64_t size) {
    if (size > bytes_.size() - at_) fail();
    at_ += static_cast<std::size_t>(size);
    at_ = std::min(bytes_.size(), (at_ + 3) / 4 * 4);
  }
  void text() { skip(count()); }

  template <class Item>
  void list(std::uint64_t tag, Item&& item) {
    const std::uint64_t found = number(4), items = count();
    if (found != tag && (found != 0 || items != 0)) fail();
    for (std::uint64_t i = 0; i < items; ++i) item();
  }

  std::uint64_t size_of_type() {
    const std::uint64_t type = number(4);
    if (type == 0 || type >= bytes_of_type.size()) fail();
    return bytes_of_type[type];
  }

  void attributes() {
    list(12, [&] {
      text();
      const std::uint64_t size = size_of_type();
      skip(product(count(), size));
    });
  }

  void variable() {
    text();
    const std::uint64_t dimensions = count();
    std::uint64_t values = 1;
    bool has_records = false;
    for (std::uint64_t i = 0; i < dimensions; ++i) {
      const std::uint64_t dimension = count();
      if (dimension >= lengths_.size()) fail();
      const std::uint64_t length = lengths_[static_cast<std::size_t>(dimension)];
      if (length == 0) has_records = true;
      values = product(values, length);
    }
    attributes();
    const std::uint64_t size = product(values, size_of_type());
    count();  // the size, which is not right in large files
    const std::uint64_t begin = number(wide_offsets_ ? 8 : 4);
    if (!has_records && (begin > bytes_.size() || size > bytes_.size() - begin)) fail();
  }

  std::string_view bytes_;
  const std::string& name_;
  bool wide_counts_, wide_offsets_;
  std::size_t at_ = 0;
  std::vector<std::uint64_t> lengths_;
};

}  // namespace

bool looks_like_classic_netcdf(std::string_view bytes) {
  return bytes.starts_with("CDF\1"sv) || bytes.starts_with("CDF\2"sv) || bytes.starts_with("CDF\5"sv);
}

void check_netcdf_header(std::string_view bytes, const std::string& name) {
  HeaderCheck(bytes, name).run();
}

}  // namespace hexpipe::formats
