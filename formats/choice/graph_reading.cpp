#include "formats/choice/graph_reading.hpp"

#include "formats/choice/dimacs.hpp"
#include "formats/choice/edge_list.hpp"
#include "formats/choice/edges.hpp"
#include "formats/choice/matrix_market.hpp"
#include "formats/choice/metis.hpp"

namespace hexpipe::formats {
namespace {

GraphFormat format_of(Input& input) {
  if (looks_like_matrix_market(input)) return GraphFormat::matrix_market;
  if (looks_like_dimacs(input)) return GraphFormat::dimacs;
  if (looks_like_edge_list(input)) return GraphFormat::edges;
  return GraphFormat::metis;
}

}  // namespace

const std::map<std::string, GraphFormat>& graph_formats() {
  static const std::map<std::string, GraphFormat> formats{{"metis", GraphFormat::metis},
                                                          {"dimacs", GraphFormat::dimacs},
                                                          {"matrix-market", GraphFormat::matrix_market},
                                                          {"edges", GraphFormat::edges}};
  return formats;
}

graph::ConflictGraph read_graph(Input& input, const GraphReading& reading, LeftOut* left_out) {
  LeftOut unheard;
  LeftOut& told = left_out != nullptr ? *left_out : unheard;
  const GraphFormat format = reading.format ? *reading.format : format_of(input);
  const auto read = [&] {
    switch (format) {
      case GraphFormat::dimacs:
        return read_dimacs(input, reading, told);
      case GraphFormat::matrix_market:
        return read_matrix_market(input, told);
      case GraphFormat::edges:
        return read_edge_list(input, told);
      case GraphFormat::metis:
        break;
    }
    return read_metis(input, reading, told);
  };
  graph::ConflictGraph graph = read();
  if (reading.complement) return complement_of(graph, input.name());
  return graph;
}

}  // namespace hexpipe::formats
