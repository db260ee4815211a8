#pragma once
// The binary data of VTK's XML files: raw or base64, plain or in blocks compressed by zlib, behind a header of lengths.

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace hexpipe::formats {

struct VtkXmlEncoding {
  std::endian order = std::endian::little;
  bool long_header = false;  // numbers of headers have 64 bits, otherwise 32
  bool compressed = false;   // by zlib
};

// Takes bytes that a file holds raw or as base64, from the front. Where an encoded run ends in padding, the next one
// follows. Throws DataError, with a message that begins with `where`, when bytes are missing or are not base64.
class EncodedBytes {
 public:
  EncodedBytes(std::string_view text, bool base64, std::string_view where)
      : text_(text), where_(where), base64_(base64) {}

  // Valid until the next call.
  std::string_view take(std::uint64_t count);
  // An upper bound on the bytes that can be taken.
  std::uint64_t most_left() const;

 private:
  void decode_group();

  std::string_view text_;
  std::string where_;
  bool base64_;
  std::string decoded_;
  std::size_t used_ = 0;  // of decoded_
};

// The uncompressed content of one data array, which lies in `bytes` or in `storage`. The sizes in a header are checked
// against the bytes that are there before anything is allocated.
std::string_view read_vtk_xml_data(EncodedBytes& bytes, const VtkXmlEncoding& encoding, std::string_view where,
                                   std::string& storage);

}  // namespace hexpipe::formats
