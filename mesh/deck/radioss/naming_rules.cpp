#include "mesh/deck/radioss/naming_rules.h"

#include <algorithm>
#include <string>

namespace prismesh::mesh::deck::radioss {
namespace {

constexpr auto kNodeRef = Referred::node;
constexpr auto kShellRef = Referred::shell;
constexpr auto kSolidRef = Referred::solid;
constexpr auto kBeamRef = Referred::beam;
constexpr auto kSpringRef = Referred::discrete;
constexpr auto kAnyElementRef = Referred::any_element;
constexpr auto kPartRef = Referred::part;

constexpr NamingPlace kFirstCard{1, false, 1, 1};
constexpr NamingPlace kEveryCard{1, true, 1, 1};

// In alphabetical order. Of the rules that fit, the one with the most words counts.
constexpr NamingRule kRules[] = {
    {"ACCEL", Naming::places, kNodeRef, kFirstCard},
    {"ACTIV"},
    {"ADMAS/0"},
    {"ADMAS/1"},
    {"ADMAS/2"},
    {"ADMAS/3"},
    {"ADMAS/4"},
    {"ADMAS/5", Naming::places, kNodeRef, {1, true, 3, 1}},
    {"ADMAS/6", Naming::places, kPartRef, {1, true, 3, 1}},
    {"ADMAS/7", Naming::places, kPartRef, {1, true, 3, 1}},
    {"ALE"},
    {"AMS"},
    {"ANALY"},
    {"ANIM"},
    {"BCS"},
    {"BEGIN"},
    {"BOX", Naming::places, kNodeRef, {1, false, 1, 2}},
    {"BOX/BOX"},
    {"CAA"},
    {"CLOAD"},
    {"CNODE"},
    {"CONVEC"},
    {"CYL_JOINT", Naming::places, kNodeRef, {1, false, 1, 2}},
    {"DAMP"},
    {"DEFAULT"},
    {"DEF_SHELL"},
    {"DEF_SOLID"},
    {"DT"},
    {"DTIX"},
    {"EOS"},
    {"EULER"},
    {"FAIL"},
    {"FRAME/FIX"},
    {"FRAME/MOV", Naming::places, kNodeRef, {1, false, 1, 3}},
    {"FRAME/MOV2", Naming::places, kNodeRef, {1, false, 1, 3}},
    {"FRAME/NOD", Naming::places, kNodeRef, kFirstCard},
    {"FRICTION"},
    {"FRIC_ORIENT"},
    {"FUNCT"},
    {"FUNCT_SMOOTH"},
    {"FUNC_2D"},
    {"GRAV"},
    {"GRBEAM"},
    {"GRBEAM/BEAM", Naming::list, kBeamRef},
    {"GRBEAM/GENE", Naming::range, kBeamRef},
    {"GRBEAM/GEN_INCR", Naming::step, kBeamRef},
    {"GRBEAM/PART", Naming::list, kPartRef},
    {"GRBRIC"},
    {"GRBRIC/BRIC", Naming::list, kSolidRef},
    {"GRBRIC/GENE", Naming::range, kSolidRef},
    {"GRBRIC/GEN_INCR", Naming::step, kSolidRef},
    {"GRBRIC/PART", Naming::list, kPartRef},
    {"GRNOD"},
    {"GRNOD/GENE", Naming::range, kNodeRef},
    {"GRNOD/GEN_INCR", Naming::step, kNodeRef},
    {"GRNOD/NODE", Naming::list, kNodeRef},
    {"GRNOD/NODENS", Naming::list, kNodeRef},
    {"GRNOD/PART", Naming::list, kPartRef},
    {"GRPART"},
    {"GRPART/GENE", Naming::range, kPartRef},
    {"GRPART/GEN_INCR", Naming::step, kPartRef},
    {"GRPART/PART", Naming::list, kPartRef},
    {"GRQUAD"},
    {"GRQUAD/GENE", Naming::range, kAnyElementRef},
    {"GRQUAD/GEN_INCR", Naming::step, kAnyElementRef},
    {"GRQUAD/PART", Naming::list, kPartRef},
    {"GRQUAD/QUAD", Naming::list, kAnyElementRef},
    {"GRSH3N"},
    {"GRSH3N/GENE", Naming::range, kShellRef},
    {"GRSH3N/GEN_INCR", Naming::step, kShellRef},
    {"GRSH3N/PART", Naming::list, kPartRef},
    {"GRSH3N/SH3N", Naming::list, kShellRef},
    {"GRSHEL"},
    {"GRSHEL/GENE", Naming::range, kShellRef},
    {"GRSHEL/GEN_INCR", Naming::step, kShellRef},
    {"GRSHEL/PART", Naming::list, kPartRef},
    {"GRSHEL/SHEL", Naming::list, kShellRef},
    {"GRSHEL/SHELL", Naming::list, kShellRef},
    {"GRSPRI"},
    {"GRSPRI/GENE", Naming::range, kSpringRef},
    {"GRSPRI/GEN_INCR", Naming::step, kSpringRef},
    {"GRSPRI/PART", Naming::list, kPartRef},
    {"GRSPRI/SPRI", Naming::list, kSpringRef},
    {"GRTRIA"},
    {"GRTRIA/GENE", Naming::range, kAnyElementRef},
    {"GRTRIA/PART", Naming::list, kPartRef},
    {"GRTRIA/TRIA", Naming::list, kAnyElementRef},
    {"GRTRUS"},
    {"GRTRUS/GENE", Naming::range, kBeamRef},
    {"GRTRUS/GEN_INCR", Naming::step, kBeamRef},
    {"GRTRUS/PART", Naming::list, kPartRef},
    {"GRTRUS/TRUS", Naming::list, kBeamRef},
    {"HEAT"},
    {"IMPACC"},
    {"IMPDISP"},
    {"IMPFLUX"},
    {"IMPTEMP"},
    {"IMPVEL"},
    {"INISTA"},
    {"INITEMP"},
    {"INIVEL/AXIS"},
    {"INIVEL/GRID"},
    {"INIVEL/ROT"},
    {"INIVEL/T+G"},
    {"INIVEL/TRA"},
    {"INTER"},
    {"INTER/TYPE2", Naming::places, Referred::node_set, kFirstCard},  // the tied nodes; its other side is a surface
    {"IOFLAG"},
    {"KEY"},
    {"LEAK"},
    {"LINE"},
    {"LINE/EDGE"},
    {"LINE/PART", Naming::list, kPartRef},
    {"LINE/SEG", Naming::segments, kNodeRef, {1, true, 2, 2}},
    {"LOAD/CENTRI"},
    {"LOAD/PFLUID"},
    {"MAT"},
    {"MEMORY"},
    {"MONVOL"},
    {"MOVE_FUNCT"},
    {"NODE"},
    {"NONLOCAL"},
    {"PARAMETER"},
    {"PART"},
    {"PERTURB"},
    {"PLOAD"},
    {"PLY"},
    {"PROP"},
    {"RADIATION"},
    {"RANDOM"},
    {"RBE2", Naming::places, kNodeRef, kFirstCard},
    {"RBE3", Naming::places, kNodeRef, kFirstCard},
    {"RBODY", Naming::places, kNodeRef, kFirstCard},
    {"RLINK"},
    {"RWALL", Naming::places, kNodeRef, kFirstCard},
    {"SECT", Naming::places, kNodeRef, {1, false, 1, 3}},
    {"SECT/CIRCLE"},
    {"SECT/PARAL"},
    {"SENSOR/ACCE"},
    {"SENSOR/AND"},
    {"SENSOR/INTER"},
    {"SENSOR/NOT"},
    {"SENSOR/OR"},
    {"SENSOR/RBODY"},
    {"SENSOR/RWALL"},
    {"SENSOR/SECT"},
    {"SENSOR/SENS"},
    {"SENSOR/TIME"},
    {"SENSOR/TYPE0"},
    {"SHFRA"},
    {"SKEW/FIX"},
    {"SKEW/MOV", Naming::places, kNodeRef, {1, false, 1, 3}},
    {"SKEW/MOV2", Naming::places, kNodeRef, {1, false, 1, 3}},
    {"SPHGLO"},
    {"SPMD"},
    {"STACK"},
    {"STAMPING"},
    {"SUBSET"},
    {"SURF"},
    {"SURF/PART", Naming::list, kPartRef},
    {"SURF/SEG", Naming::segments, kNodeRef, {1, true, 2, 4}},
    {"TABLE"},
    {"TH"},
    {"TH/BEAM", Naming::places, kBeamRef, kEveryCard},
    {"TH/BRIC", Naming::places, kSolidRef, kEveryCard},
    {"TH/BRICK", Naming::places, kSolidRef, kEveryCard},
    {"TH/NODE", Naming::places, kNodeRef, kEveryCard},
    {"TH/PART", Naming::places, kPartRef, {1, true, 1, 10}},
    {"TH/QUAD", Naming::places, kAnyElementRef, kEveryCard},
    {"TH/SH3N", Naming::places, kShellRef, kEveryCard},
    {"TH/SHEL", Naming::places, kShellRef, kEveryCard},
    {"TH/SHELL", Naming::places, kShellRef, kEveryCard},
    {"TH/SPHCEL", Naming::places, Referred::sph, kEveryCard},
    {"TH/SPRING", Naming::places, kSpringRef, kEveryCard},
    {"TH/TRUSS", Naming::places, kBeamRef, kEveryCard},
    {"THERM_STRESS"},
    {"TITLE"},
    {"TRANSFORM/MATRIX"},
    {"TRANSFORM/POSITION", Naming::places, kNodeRef, {1, false, 2, 6}},
    {"TRANSFORM/ROT", Naming::places, kNodeRef, {1, false, 8, 2}},
    {"TRANSFORM/SCA", Naming::places, kNodeRef, {1, false, 8, 1}},
    {"TRANSFORM/SYM", Naming::places, kNodeRef, {1, false, 8, 2}},
    {"TRANSFORM/TRA", Naming::places, kNodeRef, {1, false, 8, 2}},
    {"UNIT"},
    {"UPWIND"},
    {"VISC"},
};

/// The number of words of a rule if a block's words begin with them, else 0.
std::size_t matching_words(const Keyword& keyword, std::string_view rule) {
  std::size_t word = 0;
  for (std::size_t begin = 0; begin <= rule.size(); ++word) {
    const std::size_t end = std::min(rule.find('/', begin), rule.size());
    const std::string_view wanted = rule.substr(begin, end - begin);
    // The kind of /ADMAS is a number.
    const bool number = word >= keyword.words.size() && word == keyword.words.size() && !keyword.numbers.empty();
    if (number ? wanted != std::to_string(keyword.numbers[0]) : keyword.word(word) != wanted) return 0;
    begin = end + 1;
  }
  return word;
}

}  // namespace

NamingRule naming_rule(const Keyword& keyword) {
  NamingRule best;
  best.naming = Naming::unknown;
  std::size_t max_words = 0;
  for (const NamingRule& rule : kRules) {
    const std::size_t words = matching_words(keyword, rule.keyword);
    if (words <= max_words) continue;
    max_words = words;
    best = rule;
  }
  return best;
}

}  // namespace prismesh::mesh::deck::radioss
