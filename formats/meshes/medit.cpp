#include "formats/meshes/medit.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "formats/meshes/mesh_blocks.hpp"
#include "formats/streams/number_writer.hpp"
#include "formats/streams/text_scanner.hpp"

namespace hexpipe::formats {
namespace {

constexpr std::string_view header = "MeshVersionFormatted";

// Spellings other than those of ElementNames that programs write.
constexpr std::pair<std::string_view, std::string_view> aliases[] = {
    {"Hexaedra", hex_names.medit}, {"Wedges", prism_names.medit}, {"Pentahedra", prism_names.medit}};

std::string_view usual_spelling(std::string_view keyword) {
  for (const auto& [alias, usual] : aliases)
    if (equal_ignoring_case(keyword, alias)) return usual;
  return keyword;
}

class MeditReader {
 public:
  MeditReader(std::string_view text, std::string_view file)
      : file_(file), ends_with_line_(text.ends_with('\n')), scanner_(text, file, '#') {}

  MixedMesh read(std::vector<std::string>* warnings) {
    scanner_.expect(header);
    const auto version = scanner_.number<int>("a version from 1 to 4");
    if (version < 1 || version > 4) scanner_.fail_expected("a version from 1 to 4", std::to_string(version));
    bool ended = false;
    while (!ended && !scanner_.at_end()) {
      const std::string_view keyword = scanner_.word("a keyword, or End");
      ended = equal_ignoring_case(keyword, "End");
      if (!ended) read_section(keyword);
    }
    if (!scanner_.at_end()) scanner_.fail_expected("nothing after End", scanner_.peek_word());
    if (!ended) accept_missing_end(warnings);
    if (!has_vertices_) scanner_.fail("expected Vertices, found none");
    if (!ridges_.empty()) mesh_.ridges = edges_at_ridges();
    return std::move(mesh_);
  }

 private:
  // Some programs leave End out. Every section is whole then, and the last line has an end, without which the last
  // number could be cut off.
  void accept_missing_end(std::vector<std::string>* warnings) const {
    const bool has_elements = mesh_.cell_count() + mesh_.triangles.size() + mesh_.quads.size() > 0;
    if (!ends_with_line_ || !has_elements) scanner_.fail_expected("a keyword, or End", "");
    if (warnings != nullptr) warnings->push_back(fmt::format("{}: there is no End; is the file cut off?", file_));
  }

  void read_section(std::string_view word) {
    const std::string_view keyword = usual_spelling(word);
    if (equal_ignoring_case(keyword, "Dimension")) return read_dimension();
    if (equal_ignoring_case(keyword, "Vertices")) return read_vertices();
    if (equal_ignoring_case(keyword, "Edges")) return read_edges();
    if (equal_ignoring_case(keyword, "Ridges")) return read_ridges();
    bool known = false;
    for_each_block(mesh_, [&](const ElementNames& names, auto& block) {
      if (!equal_ignoring_case(keyword, names.medit)) return;
      read_elements(names, block);
      known = true;
    });
    if (known) return;
    if (!is_letter(word.front())) scanner_.fail_expected("a keyword, or End", word);
    refuse_higher_order(word);
    skip_section();
  }

  void read_dimension() {
    const auto dimension = scanner_.number<int>("dimension 3");
    if (dimension != 3) scanner_.fail_expected("dimension 3", std::to_string(dimension));
  }

  void read_vertices() {
    if (has_vertices_) scanner_.fail("expected one section Vertices, found a second");
    has_vertices_ = true;
    const std::size_t count = scanner_.count("the number of vertices", 8);
    if (count > static_cast<std::size_t>(std::numeric_limits<Vertex>::max()))
      scanner_.fail_expected("fewer than 2^31 vertices", std::to_string(count));
    mesh_.points.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      mesh_.points.push_back(scanner_.point());
      scanner_.number<std::int64_t>("the reference of a vertex");
    }
    vertex_range_ = fmt::format("a vertex from 1 to {}", count);
  }

  template <class Block>
  void read_elements(const ElementNames& names, Block& block) {
    if (!has_vertices_) scanner_.fail(fmt::format("expected Vertices before {}", names.medit));
    const std::string what = fmt::format("the number of {}", names.medit);
    const std::size_t count = scanner_.count(what, 2 * (corners_of_block<Block> + 1));
    block.cells.reserve(block.size() + count);
    block.tags.reserve(block.size() + count);
    for (std::size_t i = 0; i < count; ++i) {
      auto& corners = block.cells.emplace_back();
      for (Vertex& corner : corners) corner = read_vertex();
      block.tags.push_back(scanner_.number<std::int32_t>("a reference"));
    }
  }

  void read_edges() {
    if (!has_vertices_) scanner_.fail("expected Vertices before Edges");
    const std::size_t count = scanner_.count("the number of Edges", 6);
    edges_.reserve(edges_.size() + count);
    for (std::size_t i = 0; i < count; ++i) {
      const Vertex a = read_vertex(), b = read_vertex();
      edges_.push_back({std::min(a, b), std::max(a, b)});
      scanner_.number<std::int32_t>("a reference");
    }
  }

  // Numbers of edges, which may come later in the file.
  void read_ridges() {
    const std::size_t count = scanner_.count("the number of Ridges", 2);
    ridges_.reserve(ridges_.size() + count);
    for (std::size_t i = 0; i < count; ++i) ridges_.push_back(scanner_.number<std::int64_t>("the number of an edge"));
  }

  // Each once, by its vertices.
  std::vector<Ridge> edges_at_ridges() const {
    std::vector<Ridge> result;
    for (const std::int64_t number : ridges_) {
      if (number < 1 || number > static_cast<std::int64_t>(edges_.size()))
        scanner_.fail(fmt::format("expected Ridges of edges from 1 to {}, found {}", edges_.size(), number));
      result.push_back(edges_[static_cast<std::size_t>(number - 1)]);
    }
    std::ranges::sort(result);
    result.erase(std::ranges::unique(result).begin(), result.end());
    return result;
  }

  Vertex read_vertex() {
    const auto v = scanner_.number<Vertex>(vertex_range_);
    if (v < 1 || static_cast<std::size_t>(v) > mesh_.points.size())
      scanner_.fail_expected(vertex_range_, std::to_string(v));
    return v - 1;
  }

  // HexahedraQ2, TetrahedraP3 and so on; their corners alone would be another mesh.
  void refuse_higher_order(std::string_view keyword) {
    for_each_block(mesh_, [&](const ElementNames& names, const auto&) {
      const std::string_view name = names.medit;
      if (keyword.size() == name.size() + 2 && equal_ignoring_case(keyword.substr(0, name.size()), name))
        scanner_.fail_expected("elements of first order only", keyword);
    });
  }

  // Corners, Normals and the like: a count and numbers.
  void skip_section() {
    while (!scanner_.at_end() && !is_letter(scanner_.peek_word().front())) scanner_.word("a number");
  }

  std::string_view file_;
  bool ends_with_line_;
  TextScanner scanner_;
  MixedMesh mesh_;
  std::vector<Ridge> edges_;
  std::vector<std::int64_t> ridges_;  // from 1, among the edges
  std::string vertex_range_;
  bool has_vertices_ = false;
};

void write_ridges(const std::vector<Ridge>& ridges, Output& output, LineWriter& line) {
  output.print("\nEdges\n{}\n", ridges.size());
  for (const auto& [a, b] : ridges) {
    line << a + 1 << b + 1 << 0;
    line.end_line();
  }
  output.print("\nRidges\n{}\n", ridges.size());
  for (std::size_t i = 1; i <= ridges.size(); ++i) {
    line << i;
    line.end_line();
  }
}

}  // namespace

bool looks_like_medit(std::string_view text) {
  return equal_ignoring_case(TextScanner(text, "", '#').peek_word(), header);
}

MixedMesh read_medit(std::string_view text, std::string_view file, std::vector<std::string>* warnings) {
  return MeditReader(text, file).read(warnings);
}

void write_medit(const MixedMesh& mesh, Output& output) {
  LineWriter line(output);
  // Version 2 means double precision.
  output.print("{} 2\nDimension 3\n\nVertices\n{}\n", header, mesh.points.size());
  for (const Vec3& p : mesh.points) {
    line << p.x << p.y << p.z << 0;
    line.end_line();
  }
  for_each_block(mesh, [&](const ElementNames& names, const auto& block) {
    if (block.size() == 0) return;
    output.print("\n{}\n{}\n", names.medit, block.size());
    for (std::size_t i = 0; i < block.size(); ++i) {
      for (const Vertex v : block.cells[i]) line << v + 1;
      line << block.tags[i];
      line.end_line();
    }
  });
  if (mesh.ridges) write_ridges(*mesh.ridges, output, line);
  output.print("\nEnd\n");
}

}  // namespace hexpipe::formats
