#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "formats/meshes/cell_data.hpp"
#include "formats/meshes/msh.hpp"
#include "formats/meshes/msh_collector.hpp"
#include "formats/meshes/msh_numbers.hpp"
#include "formats/streams/scalar_bytes.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

// Points and lines of any order: Gmsh's type and the number of nodes.
constexpr std::pair<int, std::size_t> skipped_types[] = {{15, 1}, {1, 2},  {8, 3},  {26, 4},  {27, 5}, {28, 6},
                                                         {62, 7}, {63, 8}, {64, 9}, {65, 10}, {66, 11}};

class MshReader {
 public:
  MshReader(std::string_view text, std::string_view file, bool wants_node_data)
      : scanner_(text, file), wants_node_data_(wants_node_data) {}

  MixedMesh read() {
    while (!scanner_.at_end()) read_section(scanner_.word("a section"));
    if (!has_format_) scanner_.fail("expected $MeshFormat, found none");
    if (!has_elements_) scanner_.fail("expected $Elements, found none");
    return mesh_.take_mesh();
  }

  MshNodeValues read_node_values() {
    MixedMesh mesh = read();
    if (!has_node_data_) scanner_.fail("expected $NodeData with one component, found none");
    std::vector<double> values(mesh.points.size(), std::numeric_limits<double>::quiet_NaN());
    for (const auto& [node, value] : node_data_) values[vertex_of(node)] = value;
    return {std::move(mesh), std::move(values)};
  }

  const GroupNames& names() const { return mesh_.names(); }

 private:
  MshNumbers numbers() { return {scanner_, binary_, size_bytes_}; }

  void read_section(std::string_view name) {
    if (!name.starts_with('$')) scanner_.fail_expected("a section", name);
    if (name == "$NOD" || name == "$ELM") scanner_.fail_expected("version 2.2 or 4.1 of the format", "1");
    const std::string_view bare = name.substr(1);
    if (bare == "MeshFormat") {
      read_format();
    } else if (bare == "PhysicalNames") {
      read_group_names();
    } else if (bare == "Nodes" || bare == "ParametricNodes") {
      read_nodes(bare == "ParametricNodes");
    } else if (bare == "Elements") {
      read_elements();
    } else if (bare == "Entities" && version_ == MshVersion::v4_1) {
      read_entities();
    } else if (bare == "PartitionedEntities" && version_ == MshVersion::v4_1) {
      read_partitioned_entities();
    } else if ((bare == "ElementData" && has_elements_) || (bare == "NodeData" && has_nodes_ && wants_node_data_)) {
      return read_data(bare);
    } else {
      return skip_to_end_of(bare);
    }
    expect_end_of(bare);
  }

  void expect_end_of(std::string_view name) {
    const std::string end = fmt::format("$End{}", name);
    if (scanner_.peek_word() != end) scanner_.fail_expected(end, scanner_.peek_word());
    scanner_.word(end);
  }

  void skip_to_end_of(std::string_view name) { scanner_.skip_past(fmt::format("$End{}", name)); }

  void read_format() {
    const auto version = scanner_.number<double>("a version of the format");
    if (version != 4.1 && !(version >= 2 && version < 3))
      scanner_.fail_expected("version 2.2 or 4.1 of the format", fmt::format("{}", version));
    version_ = version == 4.1 ? MshVersion::v4_1 : MshVersion::v2_2;
    const auto coding = scanner_.number<int>("0 (ASCII) or 1 (binary)");
    if (coding != 0 && coding != 1) scanner_.fail_expected("0 (ASCII) or 1 (binary)", std::to_string(coding));
    binary_ = coding == 1;
    const auto size = scanner_.number<int>("a data size of 4 or 8");
    if (size != 4 && size != 8) scanner_.fail_expected("a data size of 4 or 8", std::to_string(size));
    size_bytes_ = static_cast<std::size_t>(size);
    has_format_ = true;
    if (binary_) check_byte_order();
  }

  void check_byte_order() {
    scanner_.rest_of_line();
    const std::int32_t one = numbers().integer("the number one");
    if (swap_bytes(one) == 1) scanner_.fail("expected this machine's byte order, found the other one");
    if (one != 1) scanner_.fail_expected("the number one", std::to_string(one));
  }

  // Numbers of groups and names in quotes, also in binary files as text.
  void read_group_names() {
    const std::size_t count = scanner_.count("the number of groups", 6);
    for (std::size_t i = 0; i < count; ++i) {
      const auto dimension = scanner_.number<int>("a dimension");
      const auto number = scanner_.number<std::int32_t>("the number of a group");
      mesh_.name_group(dimension, number, quoted_rest_of_line());
    }
  }

  std::string_view quoted_rest_of_line() {
    const std::string_view rest = scanner_.rest_of_line();
    const std::size_t begin = rest.find('"'), end = rest.rfind('"');
    if (begin == end) scanner_.fail_expected("a name in quotes", rest);
    return rest.substr(begin + 1, end - begin - 1);
  }

  // Which physical group an entity is in; the first if there are several.
  void read_entities() {
    if (binary_) scanner_.rest_of_line();
    MshNumbers in = numbers();
    std::array<std::size_t, 4> counts{};
    for (std::size_t& count : counts) count = in.count("the number of entities", 5, 4 + 3 * 8);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i) read_entity(in, dimension);
  }

  void read_entity(MshNumbers& in, int dimension) {
    read_extent_and_groups(in, dimension, in.integer("the number of an entity"));
  }

  void read_extent_and_groups(MshNumbers& in, int dimension, std::int32_t entity) {
    const int coordinates = dimension == 0 ? 3 : 6;
    for (int i = 0; i < coordinates; ++i) in.real("a coordinate of an entity");
    const std::size_t groups = in.count("the number of physical groups", 1, 4);
    for (std::size_t i = 0; i < groups; ++i) {
      const std::int32_t group = in.integer("the number of a physical group");
      if (i == 0) groups_[{dimension, entity}] = group;
    }
    if (dimension == 0) return;
    const std::size_t bounds = in.count("the number of bounding entities", 1, 4);
    for (std::size_t i = 0; i < bounds; ++i) in.integer("the number of an entity");
  }

  // In a partitioned mesh elements belong to parts of entities, which name the whole ones.
  void read_partitioned_entities() {
    if (binary_) scanner_.rest_of_line();
    MshNumbers in = numbers();
    in.size("the number of partitions");
    const std::size_t ghosts = in.count("the number of ghost entities", 2, 2 * 4);
    for (std::size_t i = 0; i < 2 * ghosts; ++i) in.integer("a number of a ghost entity");
    std::array<std::size_t, 4> counts{};
    for (std::size_t& count : counts) count = in.count("the number of partitioned entities", 7, 5 * 4 + 3 * 8);
    for (int dimension = 0; dimension < 4; ++dimension)
      for (std::size_t i = 0; i < counts[static_cast<std::size_t>(dimension)]; ++i)
        read_partitioned_entity(in, dimension);
  }

  void read_partitioned_entity(MshNumbers& in, int dimension) {
    const std::int32_t entity = in.integer("the number of an entity");
    const std::int32_t whole_dimension = in.integer("the dimension of a whole entity");
    const std::int32_t whole = in.integer("the number of a whole entity");
    const std::size_t partitions = in.count("the number of partitions", 1, 4);
    for (std::size_t i = 0; i < partitions; ++i) in.integer("the number of a partition");
    read_extent_and_groups(in, dimension, entity);
    wholes_[{dimension, entity}] = {whole_dimension, whole};
  }

  // The group and the entity of elements of `entity`; nothing for facets between partitions, which the mesh did not
  // have before it was cut.
  std::optional<MshElementNumbers> numbers_of(int dimension, std::int32_t entity) const {
    const auto group_of = [&](std::int32_t number) {
      const auto found = groups_.find({dimension, number});
      return found == groups_.end() ? 0 : found->second;
    };
    const auto part = wholes_.find({dimension, entity});
    if (part == wholes_.end()) return MshElementNumbers{0, group_of(entity), entity};
    const auto [whole_dimension, whole] = part->second;
    if (whole_dimension != dimension) return std::nullopt;
    const std::int32_t group = group_of(whole);
    return MshElementNumbers{0, group != 0 ? group : group_of(entity), whole};
  }

  void read_nodes(bool parametric) {
    expect_format_before("$Nodes");
    if (has_nodes_) scanner_.fail("expected one section $Nodes, found a second");
    has_nodes_ = true;
    if (version_ == MshVersion::v2_2)
      read_nodes_2(parametric);
    else
      read_nodes_4();
    if (const auto twice = mesh_.number_nodes())
      scanner_.fail(fmt::format("expected each node once, found {} twice", *twice));
  }

  void expect_format_before(std::string_view section) {
    if (!has_format_) scanner_.fail(fmt::format("expected $MeshFormat before {}", section));
  }

  std::size_t node_count(MshNumbers& in, std::int64_t announced, std::size_t bytes) {
    const std::size_t count = in.checked_count(announced, "a number of nodes", 4, bytes);
    if (count > static_cast<std::size_t>(std::numeric_limits<Vertex>::max()))
      scanner_.fail_expected("fewer than 2^31 nodes", std::to_string(count));
    mesh_.reserve_nodes(count);
    return count;
  }

  Vec3 read_point(MshNumbers& in) {
    const double x = in.real("a coordinate");
    const double y = in.real("a coordinate");
    const double z = in.real("a coordinate");
    return {x, y, z};
  }

  // Version 2 counts in text, also in binary files.
  void read_nodes_2(bool parametric) {
    MshNumbers in = numbers();
    const std::size_t count = node_count(in, scanner_.number<std::int64_t>("the number of nodes"), 4 + 3 * 8);
    if (binary_) scanner_.rest_of_line();
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t number = in.integer("the number of a node");
      if (number < 0) scanner_.fail_expected("the number of a node", std::to_string(number));
      mesh_.add_node(number, read_point(in));
      if (parametric) skip_parameters_2(in);
    }
  }

  void skip_parameters_2(MshNumbers& in) {
    const std::int32_t dimension = in.integer("a dimension");
    in.integer("the number of an entity");
    const int parameters = dimension == 1 || dimension == 2 ? dimension : 0;
    for (int i = 0; i < parameters; ++i) in.real("a parameter");
  }

  void read_nodes_4() {
    if (binary_) scanner_.rest_of_line();
    MshNumbers in = numbers();
    const std::size_t blocks = in.count("the number of blocks of nodes", 4, 12 + size_bytes_);
    const std::size_t total = node_count(in, in.size("the number of nodes"), size_bytes_ + 3 * 8);
    in.size("the least number of a node");
    in.size("the greatest number of a node");
    for (std::size_t i = 0; i < blocks; ++i) read_node_block(in, total);
    if (mesh_.node_count() != total)
      scanner_.fail(fmt::format("expected {} nodes, found {}", total, mesh_.node_count()));
  }

  void read_node_block(MshNumbers& in, std::size_t total) {
    const std::int32_t dimension = in.integer("a dimension");
    in.integer("the number of an entity");
    const bool parametric = in.integer("0, or 1 for parametric nodes") != 0;
    const std::size_t count = in.count("the number of nodes of a block", 4, size_bytes_ + 3 * 8);
    if (count > total - mesh_.node_count()) scanner_.fail(fmt::format("expected {} nodes, found more", total));
    std::vector<std::int64_t> node_numbers(count);
    for (std::int64_t& number : node_numbers) number = in.size("the number of a node");
    for (const std::int64_t number : node_numbers) {
      mesh_.add_node(number, read_point(in));
      for (int i = 0; parametric && i < std::min(dimension, 3); ++i) in.real("a parameter");
    }
  }

  void read_elements() {
    if (!has_nodes_) scanner_.fail("expected $Nodes before $Elements");
    if (has_elements_) scanner_.fail("expected one section $Elements, found a second");
    has_elements_ = true;
    if (version_ == MshVersion::v4_1)
      read_elements_4();
    else if (binary_)
      read_binary_elements_2();
    else
      read_text_elements_2();
  }

  void read_elements_4() {
    if (binary_) scanner_.rest_of_line();
    MshNumbers in = numbers();
    const std::size_t blocks = in.count("the number of blocks of elements", 4, 12 + size_bytes_);
    const std::size_t total = in.count("the number of elements", 2, 2 * size_bytes_);
    in.size("the least number of an element");
    in.size("the greatest number of an element");
    std::size_t left = total;
    for (std::size_t i = 0; i < blocks; ++i) {
      const std::int32_t dimension = in.integer("a dimension");
      const std::int32_t entity = in.integer("the number of an entity");
      const std::int32_t type = in.integer("the type of elements");
      const std::size_t count = in.count("the number of elements of a block", 2, 2 * size_bytes_);
      if (count > left) scanner_.fail(fmt::format("expected {} elements, found more", total));
      left -= count;
      const std::optional<MshElementNumbers> of_entity = numbers_of(dimension, entity);
      MshElementNumbers element = of_entity.value_or(MshElementNumbers{});
      read_run(
          type, count,
          [&] {
            element.element = in.size("the number of an element");
            return element;
          },
          [&] { return in.size("a node"); }, of_entity.has_value());
    }
    if (left > 0) scanner_.fail(fmt::format("expected {} elements, found {}", total, total - left));
  }

  void read_text_elements_2() {
    MshNumbers in = numbers();
    const std::size_t count = in.count("the number of elements", 4, 1);
    for (std::size_t i = 0; i < count; ++i) {
      MshElementNumbers element{in.size("the number of an element")};
      const std::int32_t type = in.integer("the type of an element");
      read_tags_2(in, in.integer("the number of tags"), element);
      read_run(
          type, 1, [&] { return element; }, [&] { return in.size("a node"); });
    }
  }

  // Elements come in runs of one type and number of tags.
  void read_binary_elements_2() {
    MshNumbers in = numbers();
    std::int64_t left = scanner_.number<std::int64_t>("the number of elements");
    scanner_.rest_of_line();
    while (left > 0) {
      const std::int32_t type = in.integer("the type of elements");
      const std::int32_t count = in.integer("the number of elements of a run");
      const std::int32_t tags = in.integer("the number of tags");
      in.checked_count(count, "a number of elements", 1, 2 * sizeof(std::int32_t));
      if (count > left) scanner_.fail(fmt::format("expected {} more elements, found {}", left, count));
      left -= count;
      read_run(
          type, static_cast<std::size_t>(count),
          [&] {
            MshElementNumbers element{in.integer("the number of an element")};
            read_tags_2(in, tags, element);
            return element;
          },
          [&] { return in.integer("a node"); });
    }
  }

  // The physical group, the elementary entity, and partitions that do not matter here.
  void read_tags_2(MshNumbers& in, std::int32_t count, MshElementNumbers& element) {
    if (count < 0) scanner_.fail_expected("a number of tags", std::to_string(count));
    for (std::int32_t i = 0; i < count; ++i) {
      const std::int32_t tag = in.integer("a tag");
      if (i == 0) element.physical = tag;
      if (i == 1) element.elementary = tag;
    }
  }

  // `count` elements of one type: next_element() reads what comes before the corners, next_node() a corner.
  // They are added if they are `wanted`.
  template <class NextElement, class NextNode>
  void read_run(std::int32_t type, std::size_t count, NextElement&& next_element, NextNode&& next_node,
                bool wanted = true) {
    const bool ours = mesh_.with_block(type, [&](auto& block, const auto& add) {
      if (block.cells.empty()) block.cells.reserve(count);
      typename std::remove_cvref_t<decltype(block.cells)>::value_type corners;
      for (std::size_t i = 0; i < count; ++i) {
        const MshElementNumbers element = next_element();
        for (Vertex& corner : corners) corner = vertex_of(next_node());
        if (wanted) add(corners, element);
      }
    });
    if (ours) return;
    const std::size_t nodes = nodes_of_skipped(type);
    for (std::size_t i = 0; i < count; ++i) {
      next_element();
      for (std::size_t k = 0; k < nodes; ++k) next_node();
    }
  }

  Vertex vertex_of(std::int64_t node) {
    const Vertex v = mesh_.vertex(node);
    if (v == no_index) scanner_.fail_expected("the number of a node", std::to_string(node));
    return v;
  }

  std::size_t nodes_of_skipped(std::int32_t type) const {
    const auto* const found = std::ranges::find(skipped_types, type, &std::pair<int, std::size_t>::first);
    if (found == std::end(skipped_types))
      scanner_.fail(fmt::format("expected elements of first order, types 1 to 7 and 15, found type {}", type));
    return found->second;
  }

  // Strings, reals and integers that describe the data stand as text also in binary files.
  void read_data(std::string_view section) {
    const std::size_t strings = scanner_.count("the number of strings", 2);
    scanner_.rest_of_line();
    std::string_view name;
    for (std::size_t i = 0; i < strings; ++i) {
      const std::string_view string = quoted_rest_of_line();
      if (i == 0) name = string;
    }
    const std::size_t reals = scanner_.count("the number of reals", 2);
    for (std::size_t i = 0; i < reals; ++i) scanner_.number<double>("a real");
    const std::size_t integers = scanner_.count("the number of integers", 2);
    std::vector<std::int64_t> values(std::max<std::size_t>(integers, 3), 0);
    for (std::size_t i = 0; i < integers; ++i) values[i] = scanner_.number<std::int64_t>("an integer");
    const std::int64_t components = values[1], count = values[2];
    if (section == "ElementData" && name == quality_name && components == 1) {
      read_values(count, "the number of an element", "a quality",
                  [&](std::int32_t element, double quality) { mesh_.add_quality(element, quality); });
      expect_end_of(section);
    } else if (section == "NodeData" && components == 1 && !has_node_data_) {
      has_node_data_ = true;
      read_values(count, "the number of a node", "a value",
                  [&](std::int32_t node, double value) { node_data_.emplace_back(node, value); });
      expect_end_of(section);
    } else {
      skip_to_end_of(section);
    }
  }

  template <class Take>
  void read_values(std::int64_t announced, std::string_view number_name, std::string_view value_name, Take&& take) {
    MshNumbers in = numbers();
    const std::size_t count = in.checked_count(announced, "a number of values", 2, 4 + 8);
    if (binary_) scanner_.rest_of_line();
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t number = in.integer(number_name);
      take(number, in.real(value_name));
    }
  }

  TextScanner scanner_;
  bool wants_node_data_;
  MshCollector mesh_;
  MshVersion version_ = MshVersion::v2_2;
  bool binary_ = false;
  std::size_t size_bytes_ = 8;
  bool has_format_ = false, has_nodes_ = false, has_elements_ = false, has_node_data_ = false;
  std::vector<std::pair<std::int32_t, double>> node_data_;
  std::map<std::pair<int, std::int32_t>, std::int32_t> groups_;  // by dimension and entity
  // By dimension and number of a part of an entity: the whole one.
  std::map<std::pair<int, std::int32_t>, std::pair<std::int32_t, std::int32_t>> wholes_;
};

}  // namespace

bool looks_like_msh(std::string_view text) {
  return TextScanner(text, "").peek_word().starts_with('$');
}

MixedMesh read_msh(std::string_view text, std::string_view file, GroupNames* names) {
  MshReader reader(text, file, false);
  MixedMesh mesh = reader.read();
  if (names != nullptr) *names = reader.names();
  return mesh;
}

MshNodeValues read_msh_node_values(std::string_view text, std::string_view file) {
  return MshReader(text, file, true).read_node_values();
}

}  // namespace hexpipe::formats
