#include "mesh/deck/lsdyna/companion_files.h"

#include <algorithm>
#include <cstdint>

#include "mesh/deck/lsdyna/includes.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

/// Where the name stands: in the data line `card` (from 1) from `column` (from 0) on. Card 0: in any of the first lines, if it is one at
/// all.
struct FileRule {
  std::string_view keyword;  ///< with options behind it or without
  std::uint8_t card = 0;
  std::uint8_t column = 0;
};

constexpr FileRule kFileRules[] = {
    {"BOUNDARY_MCOL", 2, 10},
    {"BOUNDARY_RADIATION_ENCLOSURE"},
    {"CHEMISTRY_BATTERY"},
    {"CHEMISTRY_CONTROL_1D"},
    {"CHEMISTRY_CONTROL_BLAST1D"},
    {"CHEMISTRY_MODEL"},
    {"CONTROL_EOS_USER_LIBRARY"},
    {"CONTROL_FORMING_BESTFIT", 2, 0},
    {"CONTROL_FORMING_GENERATE_BLANKMESH"},
    {"CONTROL_FORMING_ONESTEP"},
    {"CONTROL_FORMING_PARAMETER_READ", 1, 0},
    {"CONTROL_IMPLICIT_MODAL_DYNAMIC"},
    {"CONTROL_IMPLICIT_RESIDUAL_VECTOR"},
    {"CONTROL_MPP_DECOMPOSITION_FILE"},
    {"CONTROL_MPP_DECOMPOSITION_RCBLOG"},
    {"CONTROL_REFERENCE_CONFIGURATION", 1, 10},
    {"CONTROL_REFERENCE_CONTROL_VOLUME_COORDINATES"},
    {"DATABASE_FREQUENCY_BINARY"},
    {"DEFINE_COORDINATE_SYSTEM_IGES"},
    {"DEFINE_CURVE_DRAWBEAD"},
    {"DEFINE_CURVE_TRIM"},
    {"DEFINE_MULTI_DRAWBEADS_IGES", 1, 0},
    {"DEFINE_QUASAR_COUPLING"},
    {"DEFINE_SPH_AMBIENT_DRAG"},
    {"DEFINE_SPH_MESH_OBJ", 1, 0},
    {"DEFINE_TABLE_MATRIX", 1, 10},
    {"DEFINE_TWINBUILDER_COUPLING", 1, 0},
    {"DUALCESE_INCLUDE_MODEL", 1, 0},
    {"DUALCESE_MODEL", 1, 10},
    {"EFV_FILLING_BLOCK", 1, 0},
    {"ELEMENT_DIRECT_MATRIX_INPUT", 2, 0},
    {"FATIGUE"},
    {"FREQUENCY_DOMAIN_PATH"},
    {"FREQUENCY_DOMAIN_RANDOM_VIBRATION"},
    {"FREQUENCY_DOMAIN_RESPONSE_SPECTRUM"},
    {"ICFD_INITIAL_BIN"},
    {"IGA_2D_BASIS_TRANSFORM_XYZ", 1, 10},
    {"IGA_2D_BEZIER_XYZ", 1, 10},
    {"IGA_3D_BASIS_TRANSFORM_XYZ", 1, 10},
    {"IGA_3D_BEZIER_XYZ", 1, 10},
    {"IGA_INCLUDE_BEZIER", 1, 0},
    {"INITIAL_FATIGUE_DAMAGE_RATIO"},
    {"INITIAL_VOLUME_FRACTION_LSDA"},
    {"INTERFACE_BLANKSIZE"},
    {"INTERFACE_COMPENSATION_3D"},
    {"INTERFACE_ENSIGHT"},
    {"INTERFACE_LINKING_FILE", 1, 0},
    {"INTERFACE_SSI_AUX", 1, 0},
    {"LOAD_EXTERNAL_VARIABLE"},
    {"LOAD_SEGMENT_FILE", 1, 0},
    {"LOAD_SEGMENT_FSILNK", 1, 0},
    {"LOAD_SEISMIC_SSI_AUX", 1, 0},
    {"LOAD_THERMAL_BINOUT", 2, 0},
    {"MODULE_LOAD"},
    {"PART_MODES"},
    {"PERTURBATION"},
    {"RVE_ANALYSIS_FEM", 1, 0},
};

constexpr std::size_t kMaxNameCards = 50;  ///< of a block that may name files

const FileRule* file_rule_of(std::string_view keyword) {
  const FileRule* best = nullptr;
  for (const FileRule& rule : kFileRules) {
    if (!keyword.starts_with(rule.keyword)) continue;
    if (keyword.size() > rule.keyword.size() && keyword[rule.keyword.size()] != '_') continue;
    if (best == nullptr || rule.keyword.size() > best->keyword.size()) best = &rule;
  }
  return best;
}

}  // namespace

std::vector<NamedFile> named_files(std::string_view text, const Block& block) {
  const FileRule* rule = file_rule_of(block.name);
  std::vector<NamedFile> names;
  if (rule == nullptr) return names;
  // Options that put a line before the others.
  const std::size_t first = has_word(block.name, "TITLE") || has_word(block.name, "ID") ? 1 : 0;
  Lines lines(text, block.begin, block.end);
  Line line;
  for (std::size_t card = 1; card <= kMaxNameCards && lines.next(line); ++card) {
    const bool is_certain = rule->card != 0;
    if (is_certain && card < rule->card + first) continue;
    for (const std::size_t column : {std::size_t{rule->column}, std::size_t{10}}) {
      std::string_view part = trim(line.text.substr(std::min(column, line.text.size())));
      NamedFile named{{}, line.offset, is_certain};
      for (Lines more = lines; name_goes_on(part);) {
        named.name += trim(part.substr(0, part.size() - 1));
        Line next;
        if (!more.next(next)) break;
        part = trim(next.text);
      }
      named.name += part;
      if (!named.name.empty()) names.push_back(std::move(named));
      if (is_certain) return names;
    }
  }
  return names;
}

}  // namespace prismesh::mesh::deck::lsdyna
