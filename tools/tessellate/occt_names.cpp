#include "tools/tessellate/occt_names.hpp"

#include <fmt/format.h>

#include <Interface_InterfaceModel.hxx>
#include <Quantity_Color.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TColStd_HSequenceOfExtendedString.hxx>
#include <TCollection_AsciiString.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <TopExp_Explorer.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_LayerTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <XSControl_TransferReader.hxx>
#include <algorithm>
#include <cmath>

#include "formats/streams/group_names.hpp"

namespace hexpipe::tessellate {
namespace {

bool has_own_name(const TopoDS_Shape& shape) {
  const TopAbs_ShapeEnum type = shape.ShapeType();
  return type == TopAbs_FACE || type == TopAbs_EDGE || type == TopAbs_SOLID;
}

// #rrggbb, in the colours of screens.
std::string name_of_colour(const Quantity_Color& colour) {
  Standard_Real red = 0, green = 0, blue = 0;
  colour.Values(red, green, blue, Quantity_TOC_sRGB);
  const auto byte = [](double part) { return static_cast<int>(std::lround(255 * std::clamp(part, 0.0, 1.0))); };
  return fmt::format("colour_{:02x}{:02x}{:02x}", byte(red), byte(green), byte(blue));
}

class DocumentNames {
 public:
  DocumentNames(const Handle(TDocStd_Document) & document, ShapeNames& names)
      : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
        colours_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
        layers_(XCAFDoc_DocumentTool::LayerTool(document->Main())),
        names_(names) {}

  void add() {
    TDF_LabelSequence labels;
    shapes_->GetShapes(labels);
    for (Standard_Integer i = 1; i <= labels.Length(); ++i) {
      TDF_LabelSequence parts;
      XCAFDoc_ShapeTool::GetSubShapes(labels.Value(i), parts);
      for (Standard_Integer k = 1; k <= parts.Length(); ++k) add(parts.Value(k));
    }
  }

 private:
  void add(const TDF_Label& label) {
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
    if (shape.IsNull() || !has_own_name(shape)) return;
    names_.set(shape, name_of_label(label));
    if (shape.ShapeType() != TopAbs_FACE) return;
    names_.set(shape, layer_of(label));
    names_.set(shape, colour_of(label));
  }

  std::string layer_of(const TDF_Label& label) {
    Handle(TColStd_HSequenceOfExtendedString) names;
    if (!layers_->GetLayers(label, names) || names.IsNull() || names->IsEmpty()) return {};
    return cad_name(TCollection_AsciiString(names->Value(1)).ToCString());
  }

  std::string colour_of(const TDF_Label& label) {
    Quantity_Color colour;
    for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
      if (colours_->GetColor(label, type, colour)) return name_of_colour(colour);
    return {};
  }

  Handle(XCAFDoc_ShapeTool) shapes_;
  Handle(XCAFDoc_ColorTool) colours_;
  Handle(XCAFDoc_LayerTool) layers_;
  ShapeNames& names_;
};

class BodyCollector {
 public:
  explicit BodyCollector(CadModel& model) : model_(model) {}

  void add(const TDF_Label& label, const TopLoc_Location& place, const std::string& part) {
    TDF_Label referred;
    if (XCAFDoc_ShapeTool::GetReferredShape(label, referred)) {
      std::string name = name_of_label(referred);
      if (name.empty()) name = name_of_label(label);
      return add(referred, place * XCAFDoc_ShapeTool::GetLocation(label), name.empty() ? part : name);
    }
    if (XCAFDoc_ShapeTool::IsAssembly(label)) {
      TDF_LabelSequence components;
      XCAFDoc_ShapeTool::GetComponents(label, components);
      for (Standard_Integer i = 1; i <= components.Length(); ++i) add(components.Value(i), place, part);
      return;
    }
    const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label).Moved(place);
    const std::string name = part.empty() ? name_of_label(label) : part;
    for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
      const std::string own = model_.names.of(solid.Current());
      model_.bodies.push_back({solid.Current(), own.empty() ? name : own});
    }
  }

 private:
  CadModel& model_;
};

}  // namespace

std::string cad_name(const std::string& text) {
  std::string name = formats::clean_name(text);
  // OpenCASCADE, NX and others write these if there is no name: numbers of entities among them.
  const bool is_number = name.size() > 1 && name[0] == '#' && name.find_first_not_of("0123456789", 1) == name.npos;
  const bool is_none =
      is_number || name == "NONE" || name.starts_with("=>[") || name.starts_with("Open CASCADE STEP translator");
  return is_none ? std::string() : name;
}

std::string name_of_label(const TDF_Label& label) {
  Handle(TDataStd_Name) name;
  if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
  return cad_name(TCollection_AsciiString(name->Get()).ToCString());
}

void add_entity_names(const Handle(XSControl_WorkSession) & session, ShapeNames& names) {
  const Handle(Interface_InterfaceModel) model = session->Model();
  const Handle(Transfer_TransientProcess) process = session->TransferReader()->TransientProcess();
  for (Standard_Integer i = 1; i <= model->NbEntities(); ++i) {
    const auto item = Handle(StepRepr_RepresentationItem)::DownCast(model->Value(i));
    if (item.IsNull() || item->Name().IsNull()) continue;
    std::string name = cad_name(item->Name()->ToCString());
    if (name.empty()) continue;
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, item);
    if (!shape.IsNull() && has_own_name(shape)) names.set(shape, std::move(name));
  }
}

void add_document_names(const Handle(TDocStd_Document) & document, ShapeNames& names) {
  DocumentNames(document, names).add();
}

void add_bodies(const Handle(TDocStd_Document) & document, CadModel& model) {
  TDF_LabelSequence labels;
  XCAFDoc_DocumentTool::ShapeTool(document->Main())->GetFreeShapes(labels);
  BodyCollector collector(model);
  for (Standard_Integer i = 1; i <= labels.Length(); ++i)
    collector.add(labels.Value(i), TopLoc_Location(), std::string());
}

}  // namespace hexpipe::tessellate
