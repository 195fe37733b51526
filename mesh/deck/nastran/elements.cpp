#include "mesh/deck/nastran/elements.h"

#include <algorithm>
#include <unordered_map>

#include "base/letter_case.h"

namespace prismesh::mesh::deck::nastran {
namespace {

using Class = ElementClass;
using F = NodeFields;

constexpr ElementForm kElementForms[] = {
    {"CQUAD4", Class::shell, F::shell, 1, 2, 4, 4},
    {"CQUADR", Class::shell, F::shell, 1, 2, 4, 4},
    {"CQUAD8", Class::shell, F::shell, 1, 2, 8, 4},
    {"CQUAD", Class::shell, F::shell, 1, 2, 8, 4},
    {"CTRIA3", Class::shell, F::shell, 1, 2, 3, 3},
    {"CTRIAR", Class::shell, F::shell, 1, 2, 3, 3},
    {"CTRIA6", Class::shell, F::shell, 1, 2, 6, 3},
    {"CROD", Class::beam, F::in_a_row, 1, 2, 2, 2},
    {"CTUBE", Class::beam, F::in_a_row, 1, 2, 2, 2},
    {"CONROD", Class::beam, F::in_a_row, -1, 1, 2, 2},
    {"CBAR", Class::beam, F::in_a_row, 1, 2, 2, 2},
    {"CBEAM", Class::beam, F::in_a_row, 1, 2, 2, 2},
    {"CBEND", Class::beam, F::in_a_row, 1, 2, 2, 2},
    {"CBEAM3", Class::beam, F::in_a_row, 1, 2, 3, 2},
    {"CTETRA", Class::solid, F::in_a_row, 1, 2, 10, 4},
    {"CPYRAM", Class::solid, F::in_a_row, 1, 2, 13, 5},
    {"CPYRA", Class::solid, F::in_a_row, 1, 2, 13, 5},
    {"CPENTA", Class::solid, F::in_a_row, 1, 2, 15, 6},
    {"CHEXA", Class::solid, F::in_a_row, 1, 2, 20, 8},
    {"CELAS1", Class::discrete, F::with_freedoms, 1, 2, 2, 0},
    {"CELAS2", Class::discrete, F::with_freedoms, -1, 2, 2, 0},
    {"CELAS3", Class::discrete, F::scalar_points, 1, 0, 0, 0},
    {"CELAS4", Class::discrete, F::scalar_points, -1, 0, 0, 0},
    {"CDAMP1", Class::discrete, F::with_freedoms, 1, 2, 2, 0},
    {"CDAMP2", Class::discrete, F::with_freedoms, -1, 2, 2, 0},
    {"CDAMP3", Class::discrete, F::scalar_points, 1, 0, 0, 0},
    {"CDAMP4", Class::discrete, F::scalar_points, -1, 0, 0, 0},
    {"CDAMP5", Class::discrete, F::in_a_row, 1, 2, 2, 1},
    {"CVISC", Class::discrete, F::in_a_row, 1, 2, 2, 2},
    {"CGAP", Class::discrete, F::in_a_row, 1, 2, 2, 1},
    {"CBUSH", Class::discrete, F::in_a_row, 1, 2, 2, 1},
    {"CBUSH1D", Class::discrete, F::in_a_row, 1, 2, 2, 1},
    {"CBUSH2D", Class::discrete, F::in_a_row, 1, 2, 2, 1},
    {"CWELD", Class::discrete, F::weld, 1, 2, 0, 0},
    {"CFAST", Class::discrete, F::fastener, 1, 2, 0, 0},
    {"CMASS1", Class::mass, F::with_freedoms, 1, 2, 2, 0},
    {"CMASS2", Class::mass, F::with_freedoms, -1, 2, 2, 0},
    {"CMASS3", Class::mass, F::scalar_points, 1, 0, 0, 0},
    {"CMASS4", Class::mass, F::scalar_points, -1, 0, 0, 0},
    {"CONM1", Class::mass, F::in_a_row, -1, 1, 1, 1},
    {"CONM2", Class::mass, F::in_a_row, -1, 1, 1, 1},
    {"CSHEAR", Class::other, F::in_a_row, 1, 2, 4, 4},
    {"CTRIAX", Class::other, F::in_a_row, 1, 2, 6, 3},
    {"CTRIAX6", Class::other, F::in_a_row, -1, 2, 6, 3},
    {"CQUADX", Class::other, F::in_a_row, 1, 2, 9, 4},
    {"CPLSTN3", Class::other, F::in_a_row, 1, 2, 3, 3},
    {"CPLSTN4", Class::other, F::in_a_row, 1, 2, 4, 4},
    {"CPLSTN6", Class::other, F::in_a_row, 1, 2, 6, 3},
    {"CPLSTN8", Class::other, F::in_a_row, 1, 2, 8, 4},
    {"PLOTEL", Class::other, F::pairs, -1, 1, 2, 2},
    {"PLOTEL3", Class::other, F::in_a_row, -1, 1, 3, 3},
    {"PLOTEL4", Class::other, F::in_a_row, -1, 1, 4, 4},
    {"RBE1", Class::other, F::rbe1, -1, 1, 0, 1},
    {"RBE2", Class::other, F::rbe2, -1, 1, 0, 1},
    {"RBE3", Class::other, F::rbe3, -1, 2, 0, 1},
    {"RBAR", Class::other, F::in_a_row, -1, 1, 2, 2},
    {"RBAR1", Class::other, F::in_a_row, -1, 1, 2, 2},
    {"RROD", Class::other, F::in_a_row, -1, 1, 2, 2},
    {"RJOINT", Class::other, F::in_a_row, -1, 1, 2, 2},
    {"RTRPLT", Class::other, F::in_a_row, -1, 1, 3, 3},
    {"RSPLINE", Class::other, F::rspline, -1, 2, 0, 2},
    {"RSSCON", Class::other, F::rsscon, -1, 2, 0, 0},
    {"CAERO1", Class::other, F::none_shown, -1, 0, 0, 0},
    {"CAERO2", Class::other, F::none_shown, -1, 0, 0, 0},
    {"CAERO3", Class::other, F::none_shown, -1, 0, 0, 0},
    {"CAERO4", Class::other, F::none_shown, -1, 0, 0, 0},
    {"CAERO5", Class::other, F::none_shown, -1, 0, 0, 0},
};

/// NASTRAN-95 User's Manual, section 2.4; a CHEXA1 is no CHEXA.
constexpr std::string_view kOld[] = {"CQUAD1",  "CQUAD2",   "CTRIA1", "CTRIA2",  "CTRBSC",  "CTRPLT",  "CTRMEM",  "CQDMEM",  "CQDMEM1",
                                     "CQDMEM2", "CQDPLT",   "CTRIM6", "CTRPLT1", "CTRSHL",  "CIHEX1",  "CIHEX2",  "CIHEX3",  "CIS2D8",
                                     "CWEDGE",  "CHEXA1",   "CHEXA2", "CTORDRG", "CTRIARG", "CTRAPRG", "CTRAPAX", "CTRIAAX", "CCONEAX",
                                     "CELBOW",  "CTRIARG1", "CFTUBE", "CDUM1",   "CDUM2",   "CDUM3",   "CDUM4",   "CDUM5"};

constexpr std::string_view kUnread[] = {
    "CACINF3", "CACINF4", "CAABSF",  "CHACAB", "CHACBR",  "CHBDYE",  "CHBDYG",  "CHBDYP",  "CRAC2D",  "CRAC3D",  "CSEAM",   "CSEAMP",
    "CSPOT",   "CFILLET", "CBUTT",   "CLAP",   "CPLSTS3", "CPLSTS4", "CPLSTS6", "CPLSTS8", "CTRAX3",  "CTRAX6",  "CQUADX4", "CQUADX8",
    "CIFHEX",  "CIFPENT", "CIFQUAD", "CIFQDX", "CCRSFIL", "CSLOT3",  "CSLOT4",  "CFLUID2", "CFLUID3", "CFLUID4", "CAXIF2",  "CAXIF3",
    "CAXIF4",  "CONVM",   "GENEL",   "CHEXCZ", "CPENTCZ", "CNTNR",   "CDUMMY",  "RBJOINT", "RBJSTIF", "CQUADP",  "CTRIAP",  "CBEAR",
    "CSUPER",  "CSUPEXT", "CIHEX",   "CELASX", "JOINTG",  "CTAXI",   "CTRIX",   "CSHEARP", "CWSEAM"};

/// Ids from `begin` to the last field, each `step`th; stops at a number with a point.
void take(const Card& card, std::size_t begin, std::size_t end, std::size_t step, std::vector<std::int64_t>& nodes) {
  for (std::size_t f = begin; f < std::min(end, card.size()); f += step)
    if (const std::int64_t id = card.integer_or_zero(f); id > 0) nodes.push_back(id);
}

/// RBE1: EID GN1 CN1 GN2 CN2 GN3 CN3, continued as blank or UM, then pairs of node and freedoms.
void take_rbe1(const Card& card, std::vector<std::int64_t>& nodes) {
  for (std::size_t f = 1; f < card.size(); f += 2) {
    if (f % 8 == 7 || has_point(card.text(f))) continue;
    if (const std::int64_t id = card.integer_or_zero(f); id > 0) nodes.push_back(id);
  }
}

/// RBE2: EID GN CM GM1 GM2 ... and at last ALPHA, which has a point.
void take_rbe2(const Card& card, std::vector<std::int64_t>& nodes) {
  take(card, 1, 2, 1, nodes);
  for (std::size_t f = 3; f < card.size() && !has_point(card.text(f)); ++f) take(card, f, f + 1, 1, nodes);
}

/// RBE3: EID blank REFGRID REFC, then weight (with a point), freedoms, nodes, again and again; UM with pairs of node and freedoms.
void take_rbe3(const Card& card, std::vector<std::int64_t>& nodes) {
  take(card, 2, 3, 1, nodes);
  enum class Next { node, freedoms, pair_node, pair_freedoms, nothing } next = Next::nothing;
  for (std::size_t f = 4; f < card.size(); ++f) {
    const std::string_view text = card.text(f);
    if (text.empty()) continue;
    if (upper(text) == "UM") {
      next = Next::pair_node;
    } else if (upper(text) == "ALPHA") {
      next = Next::nothing;
    } else if (has_point(text)) {
      next = Next::freedoms;
    } else if (next == Next::freedoms) {
      next = Next::node;
    } else if (next == Next::pair_freedoms) {
      next = Next::pair_node;
    } else if (next == Next::node || next == Next::pair_node) {
      take(card, f, f + 1, 1, nodes);
      if (next == Next::pair_node) next = Next::pair_freedoms;
    }
  }
}

/// CWELD: EID PID GS type GA GB; CFAST: EID PID type IDA IDB GS GA GB. The point that is projected counts where the ends aren't given.
void take_connector(const Card& card, std::size_t projected, std::size_t ends, std::vector<std::int64_t>& nodes) {
  take(card, ends, ends + 2, 1, nodes);
  if (nodes.empty()) take(card, projected, projected + 1, 1, nodes);
}

}  // namespace

const ElementForm* element_form(std::string_view name) {
  static const auto forms = [] {
    std::unordered_map<std::string_view, const ElementForm*> out;
    for (const ElementForm& form : kElementForms) out[form.name] = &form;
    return out;
  }();
  const auto at = forms.find(name);
  return at == forms.end() ? nullptr : at->second;
}

bool is_old_element(std::string_view name) { return std::find(std::begin(kOld), std::end(kOld), name) != std::end(kOld); }

bool is_unread_element(std::string_view name) { return std::find(std::begin(kUnread), std::end(kUnread), name) != std::end(kUnread); }

ShellFields shell_fields(std::string_view name) {
  if (name == "CQUAD8") return {4, 4, 14, 15, 16, 10};
  if (name == "CQUAD") return {4, 4, 11, 0, 0, 0};
  if (name == "CTRIA6") return {3, 3, 8, 9, 13, 10};
  if (name == "CTRIA3" || name == "CTRIAR") return {3, 0, 5, 6, 9, 10};
  return {4, 0, 6, 7, 9, 10};
}

bool read_nodes(const Card& card, const ElementForm& form, std::vector<std::int64_t>& nodes) {
  nodes.clear();
  switch (form.fields) {
    case F::shell:
    case F::in_a_row:
      for (std::size_t n = 0; n < form.nodes; ++n) {
        const std::int64_t id = card.integer_or_zero(form.first + n);
        if (id > 0)
          nodes.push_back(id);
        else if (n < form.corners)
          return false;
      }
      return true;
    case F::with_freedoms:
      for (const std::size_t f : {std::size_t{2}, std::size_t{4}})
        if (card.integer_or_zero(f + 1) > 0) take(card, f, f + 1, 1, nodes);
      return true;
    case F::pairs: take(card, 1, 3, 1, nodes); return nodes.size() == 2;
    case F::rbe1: take_rbe1(card, nodes); break;
    case F::rbe2: take_rbe2(card, nodes); break;
    case F::rbe3: take_rbe3(card, nodes); break;
    case F::rspline:
      take(card, 2, 4, 1, nodes);
      take(card, 5, card.size(), 2, nodes);
      break;
    case F::rsscon:
      if (upper(card.text(1)) == "GRID") take(card, 2, card.size(), 1, nodes);
      break;
    case F::weld: take_connector(card, 2, 4, nodes); break;
    case F::fastener: take_connector(card, 5, 6, nodes); break;
    case F::scalar_points:
    case F::none_shown: break;
  }
  return nodes.size() >= form.corners;
}

}  // namespace prismesh::mesh::deck::nastran
