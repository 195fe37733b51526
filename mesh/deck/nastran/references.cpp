#include "mesh/deck/nastran/references.h"

#include <algorithm>
#include <unordered_map>

#include "base/letter_case.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::nastran {
namespace {

using Role = ReferenceRole;

/// Cards with a list of ids, and the data field at which it begins.
constexpr std::size_t kListOfSet = 8, kListOfSet3 = 2;

/// What each data field of a card is: s the set's id, n a grid point, e an element; N, E, B (either) a list with ranges that goes on to the
/// card's end; | the fields of each further line. Others say nothing.
struct Pattern {
  std::string_view name;
  std::string_view fields;
};

constexpr Pattern kPatterns[] = {
    {"SPC", "sn..n.."},
    {"SPCD", "sn..n.."},
    {"SPCR", "sn..n.."},
    {"SPC1", "s.N"},
    {"SPCOFF", "n.n.n.n."},
    {"SPCOFF1", ".N"},
    {"MPC", "sn..n...|.n..n..."},
    {"FORCE", "sn"},
    {"MOMENT", "sn"},
    {"FORCE1", "sn.nn"},
    {"MOMENT1", "sn.nn"},
    {"FORCE2", "sn.nnnn"},
    {"MOMENT2", "sn.nnnn"},
    {"PLOAD", "s.nnnn"},
    {"PLOAD1", "se"},
    {"PLOAD2", "s.E"},
    {"TEMP", "sn.n.n."},
    {"TEMPP1", "se......|E"},
    {"TEMPRB", "se......|E"},
    {"SLOAD", "sn.n.n."},
    {"DAREA", "sn..n.."},
    {"DELAY", "sn..n.."},
    {"DPHASE", "sn..n.."},
    {"ASET", "n.n.n.n."},
    {"BSET", "n.n.n.n."},
    {"CSET", "n.n.n.n."},
    {"OMIT", "n.n.n.n."},
    {"QSET", "n.n.n.n."},
    {"SUPORT", "n.n.n.n."},
    {"ASET1", ".N"},
    {"BSET1", ".N"},
    {"CSET1", ".N"},
    {"OMIT1", ".N"},
    {"QSET1", ".N"},
    {"SUPORT1", "sn.n.n."},
    {"SESET", "sN"},
    {"SEBSET", "sn.n.n."},
    {"SECSET", "sn.n.n."},
    {"SEQSET", "sn.n.n."},
    {"SESUP", "sn.n.n."},
    {"SEBSET1", "s.N"},
    {"SECSET1", "s.N"},
    {"SEQSET1", "s.N"},
    {"USET", ".n.n.n."},
    {"USET1", "..N"},
    {"SET1", "sN"},
    {"EIGR", "s.......|.n"},
    {"EIGB", "s.......|.n"},
    {"EIGC", "s..n"},
    {"CORD1R", ".nnn.nnn"},
    {"CORD1C", ".nnn.nnn"},
    {"CORD1S", ".nnn.nnn"},
    {"CORD3G", "......n"},
    {"BSURF", "sE"},
    {"BSURFS", "s...ennn|ennnennn"},
    {"RFORCE", "sn"},
    {"TIC", "sn"},
    {"ACCEL1", "s.......|N"},
    {"SEQGP", "n.n.n.n."},
    {"CNGRNT", "eE"},
    {"SEELT", "sE"},
    {"FEFACE", ".nnnn"},
    {"FEEDGE", ".nn"},
    {"PLOADX", "s..nnn"},
    {"PLOADX1", "se..nn"},
    {"QBDY1", "s.E"},
    {"QVOL", "s..E"},
    {"QHBDY", "s...nnnn"},
    {"BNDGRID", ".N"},
    {"RELEASE", "s.N"},
    {"TF", "sn......|n"},
    {"SEBNDRY", "..N"},
    {"SEEXCLD", "..N"},
    {"SELOC", "snnn"},
    {"CBARAO", "e"},
    {"ELIST", "sE"},
    {"DVGRID", "sn"},
    {"DVCREL1", "s.e"},
    {"DVCREL2", "s.e"},
    {"BLSEG", "sN"},
};

/// Entries that name neither grid points nor elements.
constexpr std::string_view kSilent[] = {
    "PARAM",   "LOAD",    "DLOAD",   "LSEQ",   "SPCADD",  "MPCADD",  "GRAV",    "EIGRL",   "DESVAR",  "DCONSTR", "DCONADD", "DEQATN",
    "DTABLE",  "DRESP2",  "DRESP3",  "DLINK",  "DDVAL",   "DOPTPRM", "DSCREEN", "DVPREL1", "DVPREL2", "DVMREL1", "DVMREL2", "MDLPRM",
    "AESTAT",  "AEROS",   "AERO",    "AESURF", "AESURFS", "AELIST",  "AECOMP",  "AELINK",  "AEPARM",  "AEFACT",  "TRIM",    "FLUTTER",
    "FLFACT",  "MKAERO1", "MKAERO2", "GUST",   "DIVERG",  "CSSCHD",  "NLPARM",  "NLPCI",   "NLSTEP",  "TEMPD",   "GRDSET",  "ACMODL",
    "ACSRCE",  "BAROR",   "BEAMOR",  "ECHOON", "ECHOOFF", "BCPARA",  "BCTPARA", "BCTPARM", "BCTSET",  "BCTADD",  "BCTABLE", "SUPAX",
    "TIME",    "SOL",     "DTABLE2", "RANDPS", "RANDT1",  "ROTORD",  "DMI",     "TSTEP",   "TSTEPNL", "LOADCYH", "SPOINT",  "EPOINT",
    "PLPLANE", "PSET",    "PVAL",    "DSHAPE", "BNDFIX1", "CYAX"};
constexpr std::string_view kSilentBeginnings[] = {"MAT", "TABLE", "FREQ", "TLOAD", "RLOAD", "CORD2", "PAERO", "SPLINE", "MONPNT", "CAERO"};

std::string_view pattern_of(std::string_view name) {
  static const auto patterns = [] {
    std::unordered_map<std::string_view, std::string_view> out;
    for (const Pattern& pattern : kPatterns) out[pattern.name] = pattern.fields;
    return out;
  }();
  const auto at = patterns.find(name);
  return at == patterns.end() ? std::string_view() : at->second;
}

bool is_silent(std::string_view name) {
  for (const std::string_view beginning : kSilentBeginnings)
    if (name.substr(0, beginning.size()) == beginning) return true;
  return std::find(std::begin(kSilent), std::end(kSilent), name) != std::end(kSilent);
}

std::int64_t number(std::string_view word) {
  std::int64_t value = 0;
  return parse_integer(word, value) ? value : 0;
}

/// Cards of which several make one set of grid points. The fields before their list tell the sets apart.
bool is_of_group(std::string_view name) {
  static constexpr std::string_view kNames[] = {"SPC1",  "SPCOFF1", "ASET1",   "BSET1",   "CSET1",   "OMIT1",   "QSET1",
                                                "USET1", "SESET",   "SEBSET1", "SECSET1", "SEQSET1", "BNDGRID", "RELEASE"};
  return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

/// The fields before the list, as text that tells groups apart. Digits of components are sorted, since their order doesn't matter.
std::string group_of(const Card& card, std::size_t list) {
  std::string group;
  for (std::size_t f = 0; f < list; ++f) {
    std::string field = upper(card.text(f));
    if (field.find_first_not_of("0123456789") == std::string::npos && f + 1 == list) std::sort(field.begin(), field.end());
    group += field + ",";
  }
  return group;
}

bool is_list(std::string_view pattern) { return pattern.find_first_of("NEB") != std::string_view::npos; }

}  // namespace

std::size_t list_field(std::string_view name) {
  if (name == "SET") return kListOfSet;
  if (name == "SET3") return kListOfSet3;
  const std::string_view pattern = pattern_of(name);
  const std::size_t at = pattern.find_first_of("NEB");
  const std::size_t bar = pattern.find('|');
  return at != std::string_view::npos && bar < at ? 8 + at - bar - 1 : at;
}

void ReferenceReader::flush() {
  if (open_) references_.add(std::move(referrer_));
  open_ = false;
  if (!unread_.keyword.empty()) references_.add(std::exchange(unread_, {}));
}

void ReferenceReader::begin_card(std::string_view keyword, std::int64_t id, bool alone, const CardPlace& place) {
  line_ = place.offset;
  if (open_ && !alone && !alone_ && referrer_.file == place.file && referrer_.id == id && referrer_.keyword == keyword) {
    referrer_.end = place.end;
    return;
  }
  flush();
  open_ = true;
  alone_ = alone;
  referrer_ = {};
  referrer_.keyword = keyword;
  referrer_.id = id;
  referrer_.file = place.file;
  referrer_.offset = place.offset;
  referrer_.end = place.end;
}

void ReferenceReader::add(Referred referred, Role role, std::int64_t first, std::int64_t last, std::int64_t step) {
  // The referrer being collected will be added next.
  references_.add(Reference{referred, role, first, last, step, static_cast<std::uint32_t>(references_.referrers().size()), line_});
}

void ReferenceReader::add_one(Referred referred, const Card& card, std::size_t field) {
  const std::int64_t id = card.integer_or_zero(field);
  if (id > 0) add(referred, Role::single, id, id);
}

/// Ids, "a THRU b" with or without "BY c"; what EXCEPT takes out again counts as named.
void ReferenceReader::add_list(const std::vector<std::string_view>& words, Referred referred, bool both) {
  const auto put = [&](Role role, std::int64_t first, std::int64_t last, std::int64_t step) {
    add(both ? Referred::node : referred, role, first, last, step);
    if (both) add(Referred::any_element, role, first, last, step);
  };
  for (std::size_t w = 0; w < words.size(); ++w) {
    const std::int64_t id = number(words[w]);
    if (id <= 0) continue;
    if (w + 2 < words.size() && begins_with(words[w + 1], "THRU")) {
      const std::int64_t last = number(words[w + 2]);
      std::int64_t step = 1;
      w += 2;
      if (w + 2 < words.size() && upper(words[w + 1]) == "BY") {
        step = std::max<std::int64_t>(number(words[w + 2]), 1);
        w += 2;
      }
      put(Role::range, id, last, step);
    } else {
      put(Role::list, id, id, 1);
    }
  }
}

void ReferenceReader::add_list(const Card& card, std::size_t begin, Referred referred, bool both) {
  std::vector<std::string_view> words;
  for (std::size_t f = begin; f < card.size(); ++f)
    if (!card.blank(f)) words.push_back(card.text(f));
  add_list(words, referred, both);
}

void ReferenceReader::add_pattern(const Card& card, std::string_view pattern) {
  const std::size_t bar = pattern.find('|');
  const std::string_view first = pattern.substr(0, bar);
  const std::string_view further = bar == std::string_view::npos ? std::string_view() : pattern.substr(bar + 1);
  for (std::size_t f = 0; f < card.size(); ++f) {
    const bool on_first = f < 8 || further.empty();
    const std::size_t at = on_first ? f : (f - 8) % 8;
    const std::string_view fields = on_first ? first : further;
    if (at >= fields.size()) continue;
    switch (fields[at]) {
      case 'n': add_one(Referred::node, card, f); break;
      case 'e': add_one(Referred::any_element, card, f); break;
      case 'N': return add_list(card, f, Referred::node);
      case 'E': return add_list(card, f, Referred::any_element);
      case 'B': return add_list(card, f, Referred::node, true);
      default: break;
    }
  }
}

void ReferenceReader::read_element(const Card& card, const ElementForm& form, const std::vector<std::int64_t>& nodes,
                                   const CardPlace& place) {
  const std::int64_t id = card.integer_or_zero(0);
  const std::string_view name = card.name();
  const auto orientation = [&](std::size_t field) {
    if (card.blank(field) || has_point(card.text(field)) || !card.blank(field + 1)) return;
    begin_card(name, 0, false, place);
    add_one(Referred::node, card, field);
  };
  if (name[0] == 'R') {
    begin_card(name, id, true, place);
    for (const std::int64_t node : nodes) add(Referred::node, Role::single, node, node);
    if (form.fields == NodeFields::rsscon && upper(card.text(1)) == "ELEM")
      for (std::size_t f = 2; f < card.size(); ++f) add_one(Referred::any_element, card, f);
  } else if (name == "CBAR" || name == "CBEAM" || name == "CBEND" || name == "CBUSH" || name == "CGAP") {
    orientation(4);
  } else if (form.fields == NodeFields::weld) {
    begin_card(name, id, true, place);
    for (const std::size_t f : {2, 4, 5}) add_one(Referred::node, card, f);
    const std::string type = upper(card.text(3));
    for (std::size_t f = 8; f < card.size(); ++f)
      if (type != "ALIGN") add_one(type == "GRIDID" ? Referred::node : type == "PARTPAT" ? Referred::part : Referred::any_element, card, f);
  } else if (form.fields == NodeFields::fastener) {
    begin_card(name, id, true, place);
    const Referred joined = upper(card.text(2)) == "PROP" ? Referred::part : Referred::any_element;
    for (const std::size_t f : {3, 4}) add_one(joined, card, f);
    for (const std::size_t f : {5, 6, 7}) add_one(Referred::node, card, f);
  }
}

/// Reads cards whose fields depend on each other. False: the card is none of them.
bool ReferenceReader::read_special(const Card& card, const CardPlace& place) {
  const std::string_view name = card.name();
  const std::int64_t id = card.integer_or_zero(0);
  if (name == "PLOAD4") {
    const bool range = begins_with(card.text(6), "THRU");
    begin_card(name, id, range, place);
    if (range)
      add(Referred::any_element, Role::range, card.integer_or_zero(1), card.integer_or_zero(7));
    else
      for (const std::size_t f : {1, 6, 7}) add_one(f == 1 ? Referred::any_element : Referred::node, card, f);
  } else if (name == "SET" || name == "SET3") {
    const std::string what = upper(card.text(1));
    begin_card(name, id, true, place);
    const std::size_t begin = list_field(name);
    if (what == "GRID" || what == "POINT" || what == "NODE")
      add_list(card, begin, Referred::node);
    else if (begins_with(what, "ELEM"))
      add_list(card, begin, Referred::any_element);
    else if (what == "PROP")
      add_list(card, begin, Referred::part);
  } else if (name == "DMIG") {
    if (card.integer_or_zero(1) == 0) return true;
    begin_card(name, 0, false, place);
    for (std::size_t f = 1; f < card.size(); f += f == 1 ? 3 : 4) add_one(Referred::node, card, f);
  } else if (name == "DRESP1") {
    static constexpr std::string_view kAtGrids[] = {"DISP",   "VELO",   "ACCL",  "SPCFORCE", "FRDISP",
                                                    "FRVELO", "FRACCL", "TDISP", "TVELO",    "TACCL"};
    const std::string type = upper(card.text(2));
    const bool at_grids = std::find(std::begin(kAtGrids), std::end(kAtGrids), type) != std::end(kAtGrids);
    if (!at_grids && upper(card.text(3)) != "ELEM") return true;
    begin_card(name, id, false, place);
    for (std::size_t f = 7; f < card.size(); ++f) add_one(at_grids ? Referred::node : Referred::any_element, card, f);
  } else if (name == "PARAM" && upper(card.text(0)) == "GRDPNT") {
    begin_card(name, 0, false, place);
    add_one(Referred::node, card, 1);
  } else {
    return false;
  }
  return true;
}

bool ReferenceReader::read(const Card& card, const CardPlace& place) {
  if (read_special(card, place)) return true;
  const std::string_view pattern = pattern_of(card.name());
  if (pattern.empty()) return is_silent(card.name());
  begin_card(card.name(), pattern[0] == 's' ? card.integer_or_zero(0) : 0, is_list(pattern), place);
  if (is_of_group(card.name())) referrer_.group = group_of(card, list_field(card.name()));
  add_pattern(card, pattern);
  return true;
}

void ReferenceReader::read_unread(std::string_view name, const CardPlace& place) {
  if (unread_.keyword == name && unread_.file == place.file) {
    unread_.end = place.end;
    return;
  }
  flush();
  unread_ = {std::string(name.empty() ? "?" : name), place.file, place.offset, place.end, false};
}

void ReferenceReader::read_case_control(std::string_view text, std::uint32_t file, std::size_t begin, std::size_t end) {
  std::string statement;
  CardPlace place{file, 0, 0};
  for (std::size_t at = begin; at < end;) {
    const Line line = line_at(text.substr(0, end), at);
    at = line.next;
    const std::string_view content = trim(line.text.substr(0, line.text.find('$')));
    if (content.empty()) continue;
    if (statement.empty()) {
      if (content.find('=') == std::string_view::npos) continue;
      place.offset = line.offset;
    }
    statement += content;
    place.end = line.offset + line.text.size();
    if (content.back() == ',') continue;
    read_case_command(statement, place);
    statement.clear();
  }
  if (!statement.empty()) read_case_command(statement, place);
}

void ReferenceReader::read_case_command(const std::string& statement, const CardPlace& place) {
  static constexpr std::string_view kOfGrids[] = {"DISP", "VELO", "ACCE", "SPCF", "MPCF", "OLOA", "GPFO", "GPKE", "SDIS", "SVEL",
                                                  "SACC", "SVEC", "VECT", "PRES", "THER", "ENTH", "HDOT", "NLLO", "BOUT", "MAXM"};
  static constexpr std::string_view kOfElements[] = {"STRE", "ELST", "FORC", "ELFO", "STRA", "ESE",
                                                     "EKE",  "EDE",  "FLUX", "ELSU", "NLST", "GPST"};
  if (begins_with(statement, "SET ")) {
    case_sets_.emplace_back(statement, place);
    return;
  }
  const std::int64_t set = number(trim(std::string_view(statement).substr(statement.rfind('=') + 1)));
  if (set <= 0) return;
  for (const std::string_view start : kOfGrids)
    if (begins_with(statement, start)) case_uses_[set].insert(Referred::node);
  for (const std::string_view start : kOfElements)
    if (begins_with(statement, start)) case_uses_[set].insert(Referred::any_element);
}

/// A set that no known command uses may name anything.
void ReferenceReader::read_case_set(const std::string& statement, const CardPlace& place) {
  const std::size_t equals = statement.find('=');
  const std::int64_t id = number(trim(std::string_view(statement).substr(4, equals - 4)));
  const std::set<Referred>& uses = case_uses_[id];
  if (uses.empty()) return read_unread("SET", place);
  begin_card("SET", id, true, place);
  std::vector<std::string_view> words;
  for (std::size_t at = equals + 1; at < statement.size();) {
    const std::size_t end = std::min(statement.find_first_of(", \t", at), statement.size());
    if (end > at) words.push_back(std::string_view(statement).substr(at, end - at));
    at = end + 1;
  }
  add_list(words, *uses.begin(), uses.size() > 1);
}

References ReferenceReader::finish() {
  for (const auto& [statement, place] : case_sets_) read_case_set(statement, place);
  flush();
  return std::move(references_);
}

}  // namespace prismesh::mesh::deck::nastran
