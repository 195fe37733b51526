#include "mesh/deck/radioss/references.h"

#include <algorithm>
#include <array>

#include "mesh/deck/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

constexpr auto kNode = Referred::node;
constexpr auto kShell = Referred::shell;
constexpr auto kSolid = Referred::solid;
constexpr auto kBeam = Referred::beam;
constexpr auto kSpring = Referred::discrete;
constexpr auto kAny = Referred::any_element;
constexpr auto kPart = Referred::part;

constexpr NamingPlace kFirstCard{1, false, 1, 1};
constexpr NamingPlace kEveryCard{1, true, 1, 1};

// In alphabetical order. Of the rules that fit, the one with the most words counts.
constexpr NamingRule kRules[] = {
    {"ACCEL", Naming::places, kNode, kFirstCard},
    {"ACTIV"},
    {"ADMAS/0"},
    {"ADMAS/1"},
    {"ADMAS/2"},
    {"ADMAS/3"},
    {"ADMAS/4"},
    {"ADMAS/5", Naming::places, kNode, {1, true, 3, 1}},
    {"ADMAS/6", Naming::places, kPart, {1, true, 3, 1}},
    {"ADMAS/7", Naming::places, kPart, {1, true, 3, 1}},
    {"ALE"},
    {"AMS"},
    {"ANALY"},
    {"ANIM"},
    {"BCS"},
    {"BEGIN"},
    {"BOX", Naming::places, kNode, {1, false, 1, 2}},
    {"BOX/BOX"},
    {"CAA"},
    {"CLOAD"},
    {"CNODE"},
    {"CONVEC"},
    {"CYL_JOINT", Naming::places, kNode, {1, false, 1, 2}},
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
    {"FRAME/MOV", Naming::places, kNode, {1, false, 1, 3}},
    {"FRAME/MOV2", Naming::places, kNode, {1, false, 1, 3}},
    {"FRAME/NOD", Naming::places, kNode, kFirstCard},
    {"FRICTION"},
    {"FRIC_ORIENT"},
    {"FUNCT"},
    {"FUNCT_SMOOTH"},
    {"FUNC_2D"},
    {"GRAV"},
    {"GRBEAM"},
    {"GRBEAM/BEAM", Naming::list, kBeam},
    {"GRBEAM/GENE", Naming::range, kBeam},
    {"GRBEAM/GEN_INCR", Naming::step, kBeam},
    {"GRBEAM/PART", Naming::list, kPart},
    {"GRBRIC"},
    {"GRBRIC/BRIC", Naming::list, kSolid},
    {"GRBRIC/GENE", Naming::range, kSolid},
    {"GRBRIC/GEN_INCR", Naming::step, kSolid},
    {"GRBRIC/PART", Naming::list, kPart},
    {"GRNOD"},
    {"GRNOD/GENE", Naming::range, kNode},
    {"GRNOD/GEN_INCR", Naming::step, kNode},
    {"GRNOD/NODE", Naming::list, kNode},
    {"GRNOD/NODENS", Naming::list, kNode},
    {"GRNOD/PART", Naming::list, kPart},
    {"GRPART"},
    {"GRPART/GENE", Naming::range, kPart},
    {"GRPART/GEN_INCR", Naming::step, kPart},
    {"GRPART/PART", Naming::list, kPart},
    {"GRQUAD"},
    {"GRQUAD/GENE", Naming::range, kAny},
    {"GRQUAD/GEN_INCR", Naming::step, kAny},
    {"GRQUAD/PART", Naming::list, kPart},
    {"GRQUAD/QUAD", Naming::list, kAny},
    {"GRSH3N"},
    {"GRSH3N/GENE", Naming::range, kShell},
    {"GRSH3N/GEN_INCR", Naming::step, kShell},
    {"GRSH3N/PART", Naming::list, kPart},
    {"GRSH3N/SH3N", Naming::list, kShell},
    {"GRSHEL"},
    {"GRSHEL/GENE", Naming::range, kShell},
    {"GRSHEL/GEN_INCR", Naming::step, kShell},
    {"GRSHEL/PART", Naming::list, kPart},
    {"GRSHEL/SHEL", Naming::list, kShell},
    {"GRSHEL/SHELL", Naming::list, kShell},
    {"GRSPRI"},
    {"GRSPRI/GENE", Naming::range, kSpring},
    {"GRSPRI/GEN_INCR", Naming::step, kSpring},
    {"GRSPRI/PART", Naming::list, kPart},
    {"GRSPRI/SPRI", Naming::list, kSpring},
    {"GRTRIA"},
    {"GRTRIA/GENE", Naming::range, kAny},
    {"GRTRIA/PART", Naming::list, kPart},
    {"GRTRIA/TRIA", Naming::list, kAny},
    {"GRTRUS"},
    {"GRTRUS/GENE", Naming::range, kBeam},
    {"GRTRUS/GEN_INCR", Naming::step, kBeam},
    {"GRTRUS/PART", Naming::list, kPart},
    {"GRTRUS/TRUS", Naming::list, kBeam},
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
    {"LINE/PART", Naming::list, kPart},
    {"LINE/SEG", Naming::segments, kNode, {1, true, 2, 2}},
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
    {"RBE2", Naming::places, kNode, kFirstCard},
    {"RBE3", Naming::places, kNode, kFirstCard},
    {"RBODY", Naming::places, kNode, kFirstCard},
    {"RLINK"},
    {"RWALL", Naming::places, kNode, kFirstCard},
    {"SECT", Naming::places, kNode, {1, false, 1, 3}},
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
    {"SKEW/MOV", Naming::places, kNode, {1, false, 1, 3}},
    {"SKEW/MOV2", Naming::places, kNode, {1, false, 1, 3}},
    {"SPHGLO"},
    {"SPMD"},
    {"STACK"},
    {"STAMPING"},
    {"SUBSET"},
    {"SURF"},
    {"SURF/PART", Naming::list, kPart},
    {"SURF/SEG", Naming::segments, kNode, {1, true, 2, 4}},
    {"TABLE"},
    {"TH"},
    {"TH/BEAM", Naming::places, kBeam, kEveryCard},
    {"TH/BRIC", Naming::places, kSolid, kEveryCard},
    {"TH/BRICK", Naming::places, kSolid, kEveryCard},
    {"TH/NODE", Naming::places, kNode, kEveryCard},
    {"TH/PART", Naming::places, kPart, {1, true, 1, 10}},
    {"TH/QUAD", Naming::places, kAny, kEveryCard},
    {"TH/SH3N", Naming::places, kShell, kEveryCard},
    {"TH/SHEL", Naming::places, kShell, kEveryCard},
    {"TH/SHELL", Naming::places, kShell, kEveryCard},
    {"TH/SPHCEL", Naming::places, Referred::sph, kEveryCard},
    {"TH/SPRING", Naming::places, kSpring, kEveryCard},
    {"TH/TRUSS", Naming::places, kBeam, kEveryCard},
    {"THERM_STRESS"},
    {"TITLE"},
    {"TRANSFORM/MATRIX"},
    {"TRANSFORM/POSITION", Naming::places, kNode, {1, false, 2, 6}},
    {"TRANSFORM/ROT", Naming::places, kNode, {1, false, 8, 2}},
    {"TRANSFORM/SCA", Naming::places, kNode, {1, false, 8, 1}},
    {"TRANSFORM/SYM", Naming::places, kNode, {1, false, 8, 2}},
    {"TRANSFORM/TRA", Naming::places, kNode, {1, false, 8, 2}},
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
