#include "formats/pipeline/exact_shape.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "common/run/error.hpp"

namespace hexpipe::pipeline {
namespace {

constexpr std::string_view shape_member = "surface/shape.brep", tags_member = "surface/shape.json";
constexpr std::size_t largest_shape = std::size_t{1} << 31;

void parse_tags(const std::string& text, const std::string& where, ExactShape& shape) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const char* const wanted = R"({"unit": a length, "faces": [tags], "edges": [tags]})";
  if (!json.is_object()) throw DataError::at(where, "expected {}, found no such object", wanted);
  try {
    shape.unit = json.at("unit").get<double>();
    shape.face_tags = json.at("faces").get<std::vector<std::int32_t>>();
    shape.edge_tags = json.at("edges").get<std::vector<std::int32_t>>();
  } catch (const nlohmann::json::exception&) {
    throw DataError::at(where, "expected {}, found something else in it", wanted);
  }
  if (!(shape.unit > 0) || !std::isfinite(shape.unit))
    throw DataError::at(where, "expected a unit above 0, found {}", shape.unit);
}

}  // namespace

bool read_shape_member(BundleReader& reader, ExactShape& shape, BundleWriter* copy) {
  const bool is_shape = reader.name() == shape_member;
  if (!is_shape && reader.name() != tags_member) return false;
  const std::string text = reader.read_text(largest_shape);
  if (!is_shape) parse_tags(text, reader.where(), shape);
  if (copy) copy->add_text(reader.name(), text);
  if (is_shape) shape.brep = text;
  return true;
}

void write_shape_members(BundleWriter& writer, const ExactShape& shape) {
  writer.add_text(std::string(shape_member), shape.brep);
  const nlohmann::ordered_json json{{"unit", shape.unit}, {"faces", shape.face_tags}, {"edges", shape.edge_tags}};
  writer.add_text(std::string(tags_member), json.dump());
}

}  // namespace hexpipe::pipeline
