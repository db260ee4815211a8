#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "common/candidates/findhex.hpp"
#include "common/run/error.hpp"
#include "common/run/option_checks.hpp"
#include "common/run/phases.hpp"
#include "common/run/tool_main.hpp"
#include "formats/pipeline/stage.hpp"
#include "tools/findhex/part_search.hpp"
#include "tools/findhex/report.hpp"

using namespace hexpipe;
using namespace hexpipe::findhex;

int main(int argc, char** argv) {
  const std::map<std::string, CellKind> kinds{
      {"hex", CellKind::hex}, {"prism", CellKind::prism}, {"pyramid", CellKind::pyramid}};
  const std::map<std::string, candidates::CandidateQuality> qualities{
      {"corner", candidates::CandidateQuality::corner}, {"element", candidates::CandidateQuality::element}};
  const ToolInfo info{
      .name = "findhex",
      .summary = "Find every way to merge tets into hexes (prisms, pyramids): the candidates.",
      .example = "findhex --mesh engine.msh --cells hex,prism | buildgraph -o engine.tar",
      .reads = {Role::mesh},
      .product = Role::candidates,
  };
  candidates::FindhexOptions options;
  CLI::Option* feature_angle = nullptr;
  std::vector<std::string> cells{"hex"};
  std::string quality = "element", inner_vertices = "allow", folded_quads = "drop", flat_corners = "reject",
              part = "1/1";
  const auto declare = [&](CLI::App& app) {
    app.add_option("--cells", cells, "The kinds of cells to find: hex, prism, pyramid, separated by commas")
        ->check(one_of(kinds))
        ->delimiter(',')
        ->allow_extra_args(false);
    app.add_option("--min-quality", options.min_quality, "Every corner must have a scaled Jacobian greater than this")
        ->check(number_between(0, 1));
    begin_group(app, "Cells");
    app.add_option("--quality", quality,
                   "The quality to store: the least scaled Jacobian of the corners, or of the whole element")
        ->check(one_of(qualities));
    app.add_option("--inner-vertices", inner_vertices, "allow or forbid: vertices of the mesh strictly inside a cell")
        ->check(one_of({"allow", "forbid"}));
    app.add_option(
           "--folded-quads", folded_quads,
           "drop or keep: quads whose two triangles in the mesh fold over each other, or lie on both sides of a "
           "sharp edge of the surface")
        ->check(one_of({"drop", "keep"}));
    feature_angle =
        app.add_option("--feature-angle", options.feature_angle,
                       "Edges of the surface are sharp where it turns by more; MEDIT's Ridges are so anyway")
            ->check(number_between(0, 180));
    app.add_option("--flat-corners", flat_corners,
                   "reject or keep: cells that would leave a flat pyramid at the surface")
        ->check(one_of({"reject", "keep"}));
    app.add_option("--part", part, "i/k: only cells that begin in share i of k of the vertices; see Makefile.examples")
        ->group("In parts");
    app.add_option("--max-boundary-tets", options.tet_rules.max_boundary_tets,
                   "The most slivers that a cell may have on its quads; less to compare with searches that know none")
        ->group(group::experts)
        ->check(whole_number_between(0, 6).description(""));
  };
  const auto run = [&](RunContext& context) {
    if (folded_quads == "keep" && feature_angle->count() > 0)
      throw UsageError("--feature-angle does nothing with --folded-quads keep");
    options.share = parse_share(part);
    options.kinds.clear();
    for (const auto& [name, kind] : kinds)
      if (std::find(cells.begin(), cells.end(), name) != cells.end()) options.kinds.push_back(kind);
    options.quality = qualities.at(quality);
    options.tet_rules.inner_vertices = inner_vertices == "allow";
    options.tet_rules.flat_corners = flat_corners == "keep";
    options.drop_folded_quads = folded_quads == "drop";
    options.tet_rules.sharp_edges = folded_quads == "keep";

    Phases phases;
    pipeline::Stage stage(context);
    pipeline::StageData data = stage.read({.needs = {Role::mesh}, .part = true});
    const std::string source = stage.source_of(Role::mesh);
    phases.end("read");
    if (data.mesh->tets.empty())
      throw DataError::at(source, "expected tets, found none (tetmesh makes them from a surface)");
    if (data.part && options.share.count > 1)
      throw UsageError(fmt::format("--part does not go with a mesh that is {} already", title_of(*data.part)));
    candidates::FindhexResult result = data.part ? findhex_of_part(*data.mesh, *data.part, options, source.c_str())
                                                 : candidates::findhex(std::move(*data.mesh), options, source.c_str());
    phases.end("find");
    for (const auto& warning : warnings_about(result.findings)) context.warn(warning);
    for (const auto& line : summary_lines(result)) context.note(line);
    context.statistics.update(statistics_of(result));
    pipeline::CandidatesProduct product{.candidates = std::move(result.candidates)};
    if (data.part) product.keys = keys_of_own(product.candidates, *data.part, source.c_str());
    stage.write(product, {{"candidates", candidate_counts(result)}});
    phases.end("write");
    context.statistics.update(phases.seconds());
  };
  return tool_main(argc, argv, info, declare, run);
}
