#include "mesh/deck/radioss/references.h"

#include <algorithm>
#include <array>

#include "mesh/deck/text/number.h"

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

/// Whether a block's words begin with those of a rule; the number of words then, else 0.
std::size_t words_that_fit(const Keyword& keyword, std::string_view rule) {
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

class BlockReader {
 public:
  BlockReader(const Block& block, const Keyword& keyword, const NamingRule& rule, const Surroundings& around, References& references)
      : block_(block),
        rule_(rule),
        around_(around),
        references_(references),
        added_(around.contexts[block.context].added),
        width_(around.contexts[block.context].field_width()),
        lines_(around.files, block) {
    referrer_.keyword = keyword.joined();
    referrer_.id = keyword.number(keyword.word(0) == "ADMAS" ? 1 : 0);
    referrer_.id += referrer_.id > 0 ? added_.set : 0;
    referrer_.file = block.file;
    referrer_.offset = block.offset;
    referrer_.end = block.body.end;
    referrer_.style = referrer_style(width_ == kOldField, added_);
  }

  void run() {
    Line line;
    if (!lines_.next(line)) return;
    referrer_.title = std::string(trim(line.text));
    const std::uint32_t before = static_cast<std::uint32_t>(references_.referrers().size());
    referrer_index_ = before;
    references_.add(std::move(referrer_));
    for (int card = 1; lines_.next(line); card = std::min(card + 1, 255)) read_card(line, card);
  }

 private:
  std::int64_t added() const {
    if (rule_.referred == Referred::node || rule_.referred == Referred::sph) return added_.node;
    return rule_.referred == Referred::part ? added_.part : added_.element;
  }

  /// 0: blank, a word or an unknown parameter.
  std::int64_t id(const Line& line, std::size_t from_one) const {
    return around_.parameters.integer(field(line.text, width_, from_one - 1), around_.contexts, block_.context).value_or(0);
  }

  void name_one(const Line& line, std::int64_t id, ReferenceRole role) {
    // A negative id takes its entity out of the set.
    if (id < 0) role = ReferenceRole::single;
    const std::int64_t named = std::abs(id) + added();
    if (id != 0) references_.add(Reference{rule_.referred, role, named, named, 1, referrer_index_, line.offset, id < 0});
  }

  void read_card(const Line& line, int card) {
    const std::size_t fields = std::min<std::size_t>((line.text.size() + width_ - 1) / width_, 10);
    switch (rule_.naming) {
      case Naming::list:
        for (std::size_t f = 1; f <= fields; ++f) name_one(line, id(line, f), ReferenceRole::list);
        break;
      case Naming::range:
        for (std::size_t f = 1; f + 1 <= fields; f += 2) name_range(line, id(line, f), id(line, f + 1), 1);
        break;
      case Naming::step:
        for (std::size_t f = 1; f + 1 <= fields; f += 3) name_range(line, id(line, f), id(line, f + 1), id(line, f + 2));
        break;
      case Naming::segments: name_place(line, card, rule_.first, ReferenceRole::segment); break;
      case Naming::places:
        name_place(line, card, rule_.first, ReferenceRole::single);
        name_place(line, card, rule_.second, ReferenceRole::single);
        break;
      case Naming::nothing:
      case Naming::unknown: break;
    }
  }

  void name_range(const Line& line, std::int64_t first, std::int64_t last, std::int64_t step) {
    if (first <= 0 && last <= 0) return;
    references_.add(Reference{rule_.referred, ReferenceRole::range, first + added(), last + added(), std::max<std::int64_t>(step, 1),
                              referrer_index_, line.offset});
  }

  void name_place(const Line& line, int card, const NamingPlace& place, ReferenceRole role) {
    if (place.card == 0 || (place.onwards ? card < place.card : card != place.card)) return;
    for (std::size_t f = place.field; f < std::size_t{place.field} + place.fields; ++f) name_one(line, id(line, f), role);
  }

  const Block& block_;
  const NamingRule& rule_;
  const Surroundings& around_;
  References& references_;
  const IdOffsets& added_;
  std::size_t width_;
  BlockLines lines_;
  Referrer referrer_;
  std::uint32_t referrer_index_ = 0;
};

}  // namespace

NamingRule naming_rule(const Keyword& keyword) {
  NamingRule best;
  best.naming = Naming::unknown;
  std::size_t most = 0;
  for (const NamingRule& rule : kRules) {
    const std::size_t words = words_that_fit(keyword, rule.keyword);
    if (words <= most) continue;
    most = words;
    best = rule;
  }
  return best;
}

std::uint16_t referrer_style(bool old, const IdOffsets& added) {
  return static_cast<std::uint16_t>((old ? 1 : 0) | (added == IdOffsets() ? 0 : 2));
}
bool is_old(std::uint16_t referrer_style) { return (referrer_style & 1) != 0; }
bool adds_to_ids(std::uint16_t referrer_style) { return (referrer_style & 2) != 0; }

void read_references(const Block& block, const Keyword& keyword, const Surroundings& around, References& references) {
  const NamingRule rule = naming_rule(keyword);
  if (rule.naming == Naming::nothing) return;
  if (rule.naming == Naming::unknown) {
    references.add(UnreadText{keyword.joined(), block.file, block.offset, block.body.end, false});
    for (const Stretch& stretch : block.more) references.add(UnreadText{keyword.joined(), stretch.file, stretch.begin, stretch.end, false});
    return;
  }
  BlockReader(block, keyword, rule, around, references).run();
}

}  // namespace prismesh::mesh::deck::radioss
