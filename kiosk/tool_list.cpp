#include "kiosk/tool_list.h"

#include "kiosk/editor_keys.h"
#include "kiosk/tools/comparison/comparison_tool.h"
#include "kiosk/tools/contact/contact_tool.h"
#include "kiosk/tools/cutting/cutting_tool.h"
#include "kiosk/tools/exhibition/exhibition_tool.h"
#include "kiosk/tools/files/files_tool.h"
#include "kiosk/tools/find/find_tool.h"
#include "kiosk/tools/history/history_tool.h"
#include "kiosk/tools/measuring/measuring_tool.h"
#include "kiosk/tools/mesh_operations/mesh_operations_tool.h"
#include "kiosk/tools/parts/parts_tool.h"
#include "kiosk/tools/pen/pen_tool.h"
#include "kiosk/tools/quality/quality_tool.h"
#include "kiosk/tools/selection/selection_tool.h"
#include "kiosk/tools/shaping/shaping_tool.h"
#include "kiosk/tools/space_mouse/space_mouse_tool.h"
#include "kiosk/tools/tour/tour_tool.h"
#include "kiosk/tools/view/view_tool.h"
#include "kiosk/tools/welding/welding_tool.h"

namespace prismesh::kiosk {
namespace {

struct ListedTool {
  std::span<const input::KeyBinding> keys;
  std::unique_ptr<toolkit::Tool> (*make)(toolkit::ToolContext&) = nullptr;  ///< null: a table of the editor
};

template <class Made>
std::unique_ptr<toolkit::Tool> make(toolkit::ToolContext& context) {
  return std::make_unique<Made>(context);
}

/// In the order of help and menu.
const std::vector<ListedTool>& listed_tools() {
  static const std::vector<ListedTool> kTools{
      {tools::files::keys(), make<tools::files::FilesTool>},
      {kDocumentKeys},
      {tools::comparison::keys(), make<tools::comparison::ComparisonTool>},
      {tools::find::keys(), make<tools::find::FindTool>},
      {kCancelKeys},
      {tools::selection::keys(), make<tools::selection::SelectionTool>},
      {tools::shaping::keys(), make<tools::shaping::ShapingTool>},
      {tools::quality::keys(), make<tools::quality::QualityTool>},
      {tools::contact::keys(), make<tools::contact::ContactTool>},
      {tools::mesh_operations::keys(), make<tools::mesh_operations::MeshOperationsTool>},
      {tools::welding::keys(), make<tools::welding::WeldingTool>},
      {tools::measuring::keys(), make<tools::measuring::MeasuringTool>},
      {tools::cutting::keys(), make<tools::cutting::CuttingTool>},
      {tools::parts::keys(), make<tools::parts::PartsTool>},
      {{}, make<tools::history::HistoryTool>},
      {tools::view::keys(), make<tools::view::ViewTool>},
      {tools::pen::keys(), make<tools::pen::PenTool>},
      {{}, make<tools::space_mouse::SpaceMouseTool>},
      {kWindowKeys},
      {tools::tour::keys(), make<tools::tour::TourTool>},
      {{}, make<tools::exhibition::ExhibitionTool>},
  };
  return kTools;
}

}  // namespace

std::vector<std::unique_ptr<toolkit::Tool>> make_tools(toolkit::ToolContext& context) {
  std::vector<std::unique_ptr<toolkit::Tool>> made;
  for (const ListedTool& listed : listed_tools())
    if (listed.make != nullptr) made.push_back(listed.make(context));
  return made;
}

std::span<const input::KeyBinding> key_bindings() {
  static const std::vector<input::KeyBinding> kAll = [] {
    std::vector<input::KeyBinding> all;
    for (const ListedTool& listed : listed_tools()) all.insert(all.end(), listed.keys.begin(), listed.keys.end());
    return all;
  }();
  return kAll;
}

}  // namespace prismesh::kiosk
