// laplace_dealii FILE.msh: what deal.II finds in a mesh of cells of all kinds, and how it conducts heat there.
//
// The file has bodies 1 and 2 that meet at x = 2, of conductivity 1 and 3, and surfaces 1 (x = 0, temperature 0) and 2
// (x = 4, temperature 8/3); no heat flows through others. So the temperature is x below 2, and 2 + (x - 2) / 3 above.
// Writes a line for each kind of cells with their number, for each body with its volume, for each surface with its
// area, and the greatest error of a temperature. Elements of first order have their unknowns at vertices: they are
// numbered as these are, because hp::DoFHandler of deal.II 9.4 does not number pyramids beside other cells.
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_pyramid_p.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_simplex_p.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/fe_wedge_p.h>
#include <deal.II/fe/mapping_fe.h>
#include <deal.II/grid/grid_in.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/precondition.h>
#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace {

using namespace dealii;

double exact(const Point<3>& at) {
  return at[0] < 2 ? at[0] : 2 + (at[0] - 2) / 3;
}

// An element with the mapping and the rule of its kind of cells.
struct Element {
  std::unique_ptr<FiniteElement<3>> functions;
  MappingFE<3> mapping;
  FEValues<3> values;

  Element(std::unique_ptr<FiniteElement<3>> f, const Quadrature<3>& rule)
      : functions(std::move(f)),
        mapping(*functions),
        values(mapping, *functions, rule, update_gradients | update_JxW_values) {}
};

double area(const TriaIterator<TriaAccessor<2, 3, 3>>& face) {
  std::vector<unsigned> round{0, 1, 2};
  // deal.II counts the vertices of a quad row by row.
  if (face->n_vertices() == 4) round = {0, 1, 3, 2};
  Tensor<1, 3> sum;
  for (unsigned i = 1; i + 1 < round.size(); ++i) {
    const auto a = face->vertex(round[0]);
    sum += cross_product_3d(face->vertex(round[i]) - a, face->vertex(round[i + 1]) - a) / 2;
  }
  return sum.norm();
}

void conduct(const std::string& path) {
  Triangulation<3> mesh;
  // Through Gmsh: the function for streams has no prisms and pyramids.
  GridIn<3>(mesh).read_msh(path);
  std::map<std::string, Element> elements;
  elements.try_emplace("Hex", std::make_unique<FE_Q<3>>(1), QGauss<3>(2));
  elements.try_emplace("Wedge", std::make_unique<FE_WedgeP<3>>(1), QGaussWedge<3>(2));
  elements.try_emplace("Pyramid", std::make_unique<FE_PyramidP<3>>(1), QGaussPyramid<3>(2));
  elements.try_emplace("Tet", std::make_unique<FE_SimplexP<3>>(1), QGaussSimplex<3>(2));

  DynamicSparsityPattern pattern(mesh.n_vertices());
  AffineConstraints<double> fixed;
  for (const auto& cell : mesh.active_cell_iterators()) {
    for (const auto i : cell->vertex_indices()) {
      for (const auto j : cell->vertex_indices()) pattern.add(cell->vertex_index(i), cell->vertex_index(j));
    }
    for (const auto f : cell->face_indices()) {
      const auto face = cell->face(f);
      if (!face->at_boundary() || (face->boundary_id() != 1 && face->boundary_id() != 2)) continue;
      for (const auto i : face->vertex_indices()) {
        if (fixed.is_constrained(face->vertex_index(i))) continue;
        fixed.add_line(face->vertex_index(i));
        fixed.set_inhomogeneity(face->vertex_index(i), face->boundary_id() == 1 ? 0 : 8.0 / 3);
      }
    }
  }
  fixed.close();
  SparsityPattern places;
  places.copy_from(pattern);
  SparseMatrix<double> matrix(places);
  Vector<double> right(mesh.n_vertices()), temperature(mesh.n_vertices());

  std::map<std::string, int> kinds;
  std::map<int, double> volumes, areas;
  for (const auto& cell : mesh.active_cell_iterators()) {
    const std::string kind = cell->reference_cell().to_string();
    ++kinds[kind];
    auto& values = elements.at(kind).values;
    values.reinit(cell);
    const unsigned count = cell->n_vertices();
    FullMatrix<double> own(count, count);
    for (const auto q : values.quadrature_point_indices()) {
      volumes[cell->material_id()] += values.JxW(q);
      const double conductivity = cell->material_id() == 1 ? 1 : 3;
      for (unsigned i = 0; i < count; ++i) {
        for (unsigned j = 0; j < count; ++j) {
          own(i, j) += conductivity * (values.shape_grad(i, q) * values.shape_grad(j, q)) * values.JxW(q);
        }
      }
    }
    std::vector<types::global_dof_index> numbers;
    for (const auto i : cell->vertex_indices()) numbers.push_back(cell->vertex_index(i));
    fixed.distribute_local_to_global(own, Vector<double>(count), numbers, matrix, right);
    for (const auto f : cell->face_indices()) {
      if (cell->face(f)->at_boundary()) areas[cell->face(f)->boundary_id()] += area(cell->face(f));
    }
  }
  PreconditionSSOR<SparseMatrix<double>> preconditioner;
  preconditioner.initialize(matrix);
  SolverControl control(10000, 1e-14 * right.l2_norm());
  SolverCG<Vector<double>>(control).solve(matrix, temperature, right, preconditioner);
  fixed.distribute(temperature);

  double error = 0;
  for (unsigned v = 0; v < mesh.n_vertices(); ++v)
    error = std::max(error, std::abs(temperature[v] - exact(mesh.get_vertices()[v])));
  for (const auto& [kind, count] : kinds) std::cout << kind << " " << count << "\n";
  for (const auto& [body, volume] : volumes) std::cout << "volume " << body << " " << volume << "\n";
  for (const auto& [surface, size] : areas) std::cout << "area " << surface << " " << size << "\n";
  std::cout << "error " << error << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: laplace_dealii FILE.msh\n";
    return 2;
  }
  try {
    conduct(argv[1]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
