// laplace_mfem FILE.msh: what MFEM finds in a mesh of Gmsh 2.2 with cells of all kinds, and how it conducts heat there.
//
// The file has two bodies that meet at x = 2, of conductivity 1 and 3 in the order of their numbers, and surfaces 1 (x
// = 0, temperature 0) and 2 (x = 4, temperature 8/3); no heat flows through others. So the temperature is x below 2,
// and 2 + (x - 2) / 3 above. Writes a line for each kind of cells with their number, for each body with its volume, for
// each surface with its area, for each name with its number, and the greatest error of a temperature.
#include "mfem.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>

namespace {

using namespace mfem;

double exact(const Vector& at) {
  return at[0] < 2 ? at[0] : 2 + (at[0] - 2) / 3;
}

// The volume or area of an element, by a rule that is exact up to a degree.
double size_of(ElementTransformation& element, int degree) {
  const IntegrationRule& rule = IntRules.Get(element.GetGeometryType(), degree);
  double sum = 0;
  for (int q = 0; q < rule.GetNPoints(); ++q) {
    element.SetIntPoint(&rule.IntPoint(q));
    sum += rule.IntPoint(q).weight * element.Weight();
  }
  return sum;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: laplace_mfem FILE\n";
    return 2;
  }
  Mesh mesh(argv[1], 1, 1, true);
  std::map<std::string, int> kinds;
  std::map<int, double> volumes, areas;
  const std::map<Geometry::Type, std::string> names{{Geometry::CUBE, "hex"},
                                                    {Geometry::PRISM, "prism"},
                                                    {Geometry::PYRAMID, "pyramid"},
                                                    {Geometry::TETRAHEDRON, "tet"}};
  for (int i = 0; i < mesh.GetNE(); ++i) {
    ++kinds[names.at(mesh.GetElementGeometry(i))];
    // Not GetElementVolume(): its rule is too low for hexes and prisms with warped faces.
    volumes[mesh.GetAttribute(i)] += size_of(*mesh.GetElementTransformation(i), 10);
  }
  for (int i = 0; i < mesh.GetNBE(); ++i)
    areas[mesh.GetBdrAttribute(i)] += size_of(*mesh.GetBdrElementTransformation(i), 2);
  for (const auto& [kind, count] : kinds) std::cout << kind << " " << count << "\n";
  for (const auto& [body, volume] : volumes) std::cout << "volume " << body << " " << volume << "\n";
  for (const auto& [surface, size] : areas) std::cout << "area " << surface << " " << size << "\n";
  for (const std::string& name : mesh.attribute_sets.GetAttributeSetNames())
    std::cout << "named " << name << " " << mesh.attribute_sets.GetAttributeSet(name)[0] << "\n";
  for (const std::string& name : mesh.bdr_attribute_sets.GetAttributeSetNames())
    std::cout << "named " << name << " " << mesh.bdr_attribute_sets.GetAttributeSet(name)[0] << "\n";

  H1_FECollection elements(1, 3);
  FiniteElementSpace space(&mesh, &elements);
  Vector conductivities(mesh.attributes.Max());
  conductivities = 0.0;
  for (int i = 0; i < 2; ++i) conductivities[mesh.attributes[i] - 1] = i == 0 ? 1 : 3;
  PWConstCoefficient conductivity(conductivities);
  FunctionCoefficient temperature(exact);
  GridFunction found(&space);
  found = 0.0;
  Array<int> ends(mesh.bdr_attributes.Max()), fixed;
  ends = 0;
  ends[0] = ends[1] = 1;
  space.GetEssentialTrueDofs(ends, fixed);
  found.ProjectBdrCoefficient(temperature, ends);
  BilinearForm form(&space);
  form.AddDomainIntegrator(new DiffusionIntegrator(conductivity));
  form.Assemble();
  LinearForm load(&space);
  load = 0.0;
  OperatorPtr matrix;
  Vector right, solution;
  form.FormLinearSystem(fixed, found, load, matrix, solution, right);
  GSSmoother smoother(static_cast<SparseMatrix&>(*matrix));
  PCG(*matrix, smoother, right, solution, 0, 1000, 1e-28, 0);
  form.RecoverFEMSolution(solution, load, found);
  double error = 0;
  for (int v = 0; v < mesh.GetNV(); ++v)
    error = std::max(error, std::abs(found[v] - exact(Vector(mesh.GetVertex(v), 3))));
  std::cout << "error " << error << "\n";
}
