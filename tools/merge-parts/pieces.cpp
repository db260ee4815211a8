#include "tools/merge-parts/merges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <tuple>
#include <utility>

#include "common/run/error.hpp"
#include "common/run/progress.hpp"
#include "formats/meshes/mesh_files.hpp"
#include "formats/meshes/vtu.hpp"
#include "formats/pipeline/bundle.hpp"
#include "formats/pipeline/history.hpp"
#include "formats/pipeline/members.hpp"
#include "formats/pipeline/part_bundle.hpp"
#include "formats/pipeline/surface_bundle.hpp"
#include "formats/streams/input.hpp"
#include "formats/streams/output.hpp"
#include "formats/streams/output_group.hpp"
#include "tools/merge-parts/seam_check.hpp"

namespace hexpipe::merge_parts {
namespace {

using History = std::vector<nlohmann::ordered_json>;

// The entries, reduced to what all pieces have in common.
History settings_in(const History& history) {
  History result;
  for (const auto& entry : history)
    if (entry.contains("tool"))
      result.push_back({{"tool", entry["tool"]},
                        {"version", entry.value("version", "")},
                        {"options", entry.value("options", nlohmann::ordered_json::object())}});
  return result;
}

// All k pieces of one mesh, each once, one after the other.
class PieceReader {
 public:
  explicit PieceReader(const std::vector<std::string>& paths) {
    std::map<std::int32_t, std::string> found;
    for (const std::string& path : paths) {
      const MeshPiece piece = pipeline::read_piece_bundle(path, false).piece;
      if (found.empty()) first_ = piece;
      if (piece.whole != first_.whole)
        throw DataError::at(path, "expected a piece of the same mesh as {}, found one of another", paths.front());
      if (piece.parts != first_.parts)
        throw DataError::at(path, "expected one of {} pieces as {}, found one of {}", first_.parts, paths.front(),
                            piece.parts);
      const auto [twin, is_first] = found.emplace(piece.part, path);
      if (!is_first) throw DataError::at(path, "expected each piece once, found {} as in {}", piece.part, twin->second);
      if (!piece.settled && piece.parts > 1)
        throw DataError::at(path, "expected a settled piece, found one that needs another round of assemble --before");
    }
    for (std::int32_t part = 0; part < first_.parts; ++part)
      if (!found.contains(part))
        throw DataError(fmt::format("expected all {} pieces, found no piece {}", first_.parts, part));
    order_.reserve(found.size());
    for (const auto& [part, path] : found) order_.push_back(path);
  }

  // visit(piece) in the order of parts; their facets are compared.
  template <class Visit>
  void for_each(Visit&& visit) {
    SeamCheck seams;
    Step step("joining pieces", 0, 0.7);
    step.expect(static_cast<std::int64_t>(order_.size()));
    for (const std::string& path : order_) {
      pipeline::PieceBundle piece = pipeline::read_piece_bundle(path, true);
      History settings = settings_in(piece.history);
      if (path == order_.front()) settings_ = settings;
      if (path == order_.front()) names_ = piece.names;
      if (piece.names != names_)
        throw DataError::at(path, "expected a piece with the names of {}, found others", order_.front());
      if (settings != settings_)
        throw DataError::at(path, "expected a piece made with the versions and options of {}, found another",
                            order_.front());
      seams.add(piece.mesh, piece.piece, path);
      visit(std::move(piece));
      step.advance();
    }
    seams.end();
  }

  const History& settings() const { return settings_; }
  const formats::GroupNames& names() const { return names_; }
  const std::string& first() const { return order_.front(); }

 private:
  MeshPiece first_;
  std::vector<std::string> order_;
  History settings_;
  formats::GroupNames names_;
};

class Joiner {
 public:
  void add(const pipeline::PieceBundle& piece) {
    const auto begin = static_cast<Vertex>(points_.size());
    for (std::size_t v = 0; v < piece.mesh.points.size(); ++v)
      points_.push_back({piece.piece.point_number[v], static_cast<Vertex>(points_.size()), piece.mesh.points[v]});
    each_block(piece.mesh, [&](auto member) { append(mesh_.*member, piece.mesh.*member, begin); });
  }

  // Points in the order of their numbers; a point that several pieces have is one.
  MixedMesh take() {
    std::ranges::sort(points_, {}, [](const Point& p) { return std::tie(p.number, p.place); });
    std::vector<Vertex> places(points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (i == 0 || points_[i].number != points_[i - 1].number) mesh_.points.push_back(points_[i].at);
      places[points_[i].place] = static_cast<Vertex>(mesh_.points.size()) - 1;
    }
    each_block(mesh_, [&](auto member) {
      for (auto& cell : (mesh_.*member).cells)
        for (Vertex& v : cell) v = places[v];
    });
    return std::move(mesh_);
  }

 private:
  struct Point {
    std::int64_t number;
    Vertex place;
    Vec3 at;
  };

  template <class Visit>
  static void each_block(const MixedMesh&, Visit&& visit) {
    visit(&MixedMesh::hexes), visit(&MixedMesh::prisms), visit(&MixedMesh::pyramids), visit(&MixedMesh::tets);
    visit(&MixedMesh::triangles), visit(&MixedMesh::quads);
  }

  template <int Corners>
  static void append(CellBlock<Corners>& to, const CellBlock<Corners>& from, Vertex first_point) {
    for (auto cell : from.cells) {
      for (Vertex& v : cell) v += first_point;
      to.cells.push_back(cell);
    }
    to.tags.insert(to.tags.end(), from.tags.begin(), from.tags.end());
    to.quality.insert(to.quality.end(), from.quality.begin(), from.quality.end());
  }

  std::vector<Point> points_;
  MixedMesh mesh_;
};

void write_pieces(PieceReader& reader, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(path).replace_extension();
  formats::OutputGroup files;
  files.make_directory(folder.string());
  formats::Output& head = files.add(path);
  std::vector<std::string> names;
  reader.for_each([&](const pipeline::PieceBundle& piece) {
    if (piece.mesh.cell_count() == 0) return;
    const std::string name = fmt::format("part-{:04}.vtu", piece.piece.part);
    formats::Output& output = files.add((folder / name).string());
    formats::write_vtu_piece(piece.mesh, piece.piece.point_number, output);
    output.drain();
    names.push_back((folder.filename() / name).string());
  });
  formats::write_pvtu(names, head);
  files.commit();
}

// All pieces have the surface of the whole.
void copy_surface(const std::string& piece, pipeline::BundleWriter& writer) {
  formats::Input input = formats::Input::open(piece);
  pipeline::BundleReader reader(input);
  while (reader.next())
    if (pipeline::is_surface_member(reader.name())) reader.copy_to(writer);
}

void write_whole(PieceReader& reader, const std::string& path, bool compress) {
  const std::string ending(pipeline::ending_of(path));
  const auto& formats = formats::mesh_format_names();
  formats::Output output(path);
  Joiner joiner;
  reader.for_each([&](const pipeline::PieceBundle& piece) { joiner.add(piece); });
  const Step step("joining pieces", 0.7);
  const MixedMesh mesh = joiner.take();
  if (std::ranges::find(formats, ending) != formats.end()) {
    formats::write_mixed_mesh(mesh, ending, output);
  } else {
    pipeline::BundleWriter writer(output, compress || ending == pipeline::compressed_bundle_format);
    copy_surface(reader.first(), writer);
    pipeline::write_members(writer, mesh);
    if (!reader.names().empty()) writer.add_text(std::string(formats::names_member), text_of(reader.names()));
    pipeline::write_history(writer, reader.settings());
    writer.close();
  }
  output.commit();
}

}  // namespace

bool is_piece(const std::string& path) {
  // A pipe can be read only once; pieces are read more often.
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  formats::Input input = formats::Input::open(path);
  if (!pipeline::looks_like_bundle(input)) return false;
  pipeline::BundleReader reader(input);
  // History entries and names may come before the title.
  while (reader.next())
    if (pipeline::role_of_member(reader.name())) return pipeline::is_piece_title(reader.name());
  return false;
}

void merge_pieces(const std::vector<std::string>& paths, const std::string& output, bool compress) {
  PieceReader reader(paths);
  if (pipeline::ending_of(output) == "pvtu")
    write_pieces(reader, output);
  else
    write_whole(reader, output, compress);
}

}  // namespace hexpipe::merge_parts
