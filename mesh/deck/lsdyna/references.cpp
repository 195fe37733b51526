#include "mesh/deck/lsdyna/references.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "base/letter_case.h"
#include "base/parallel_for.h"
#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/lsdyna/reference_tables.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::array<int, 8> kTens = {10, 10, 10, 10, 10, 10, 10, 10};
constexpr std::array<int, 10> kEights = {8, 8, 8, 8, 8, 8, 8, 8, 8, 8};
constexpr std::array<int, 6> kMoves = {8, 16, 16, 16, 8, 8};

/// Greater than any id: for what names all there are.
constexpr std::int64_t kEveryId = std::numeric_limits<std::int64_t>::max() / 4;

/// Blocks that nobody understands and that follow each other are put together from here on, so that a deck of nothing else stays small.
constexpr std::size_t kMaxUnread = 4096;

/// How many blocks a thread takes at a time.
constexpr std::size_t kJobsAtOnce = 64;

std::span<const int> widths_of(FieldWidths widths) {
  switch (widths) {
    case FieldWidths::eights: return kEights;
    case FieldWidths::moves: return kMoves;
    case FieldWidths::tens: break;
  }
  return kTens;
}

std::int64_t offset_of(Referred referred, const IdOffsets& offsets) {
  if (is_set(referred)) return offsets.set;
  if (is_element(referred)) return offsets.element;
  return referred == Referred::node ? offsets.node : offsets.part;
}

/// Where a block's encrypted parts begin and end.
struct Encrypted {
  std::size_t begin = 0;
  std::size_t end = 0;
};

std::optional<Encrypted> find_encrypted(std::string_view text, std::size_t begin, std::size_t end) {
  while (begin < end) {
    const void* found = ::memmem(text.data() + begin, end - begin, kEncryptedBegin.data(), kEncryptedBegin.size());
    if (!found) return std::nullopt;
    const auto at = static_cast<std::size_t>(static_cast<const char*>(found) - text.data());
    if (at == 0 || text[at - 1] == '\n') {
      const std::size_t last = text.substr(0, end).find(kEncryptedEnd, at);
      const std::size_t line = last == std::string_view::npos ? last : text.find('\n', last);
      return Encrypted{at, line == std::string_view::npos || line >= end ? end : line + 1};
    }
    begin = at + 1;
  }
  return std::nullopt;
}

}  // namespace

/// Reads one block.
class BlockReader {
 public:
  using Job = ReferenceReader::Job;
  BlockReader(std::string_view text, const Job& job, const Parameters& parameters, const IdOffsets& offsets, References& out)
      : text_(text), job_(job), parameters_(parameters), offsets_(offsets), out_(out), lines_(text, job.begin, job.end) {
    name_ = trim(text.substr(job.keyword + 1, std::min(text.find('\n', job.keyword), text.size()) - job.keyword - 1))
                .substr(0, job.name_length);
    name_ = upper(name_);
  }

  void run() {
    if (job_.encrypted) return add_unread(job_.begin, job_.end, true);
    split_encrypted();
    const ReferenceRule* rule = job_.rule;
    std::string_view options;
    if (rule) options = std::string_view(name_).substr(rule->keyword.size());
    if (!rule || !read_as(*rule, options) || rule->partly || unclear_) add_unread(job_.keyword, job_.end, false);
  }

 private:
  /// What stands behind an encrypted part is read as if the part weren't there.
  void split_encrypted() {
    encrypted_ = find_encrypted(text_, job_.begin, job_.end);
    if (encrypted_) lines_ = Lines(text_, job_.begin, encrypted_->begin);
    // Those among nodes and elements are told by the walk.
    const bool told = name_.starts_with("ELEMENT_");
    for (std::optional<Encrypted> part = encrypted_; part && !told; part = find_encrypted(text_, part->end, job_.end))
      add_unread(part->begin, part->end, true);
  }

  bool next(Line& line) {
    while (!lines_.next(line)) {
      if (!encrypted_) return false;
      const std::size_t begin = encrypted_->end;
      encrypted_ = find_encrypted(text_, begin, job_.end);
      lines_ = Lines(text_, begin, encrypted_ ? encrypted_->begin : job_.end);
    }
    return true;
  }

  /// Whole numbers that parameters stand for are kept: without them a search of the text would miss them.
  void add_unread(std::size_t begin, std::size_t end, bool encrypted) {
    UnreadText unread{name_, job_.file, begin, end, encrypted, {}};
    for (std::size_t at = encrypted ? std::string_view::npos : text_.find('&', begin); at < end; at = text_.find('&', at + 1)) {
      std::size_t last = at + 1;
      while (last < end && (std::isalnum(static_cast<unsigned char>(text_[last])) || text_[last] == '_')) ++last;
      const std::optional<std::int64_t> value = parameters_.integer(text_.substr(at, last - at));
      if (value) unread.parameter_values.push_back(*value < 0 ? -*value : *value);
    }
    std::sort(unread.parameter_values.begin(), unread.parameter_values.end());
    unread.parameter_values.erase(std::unique(unread.parameter_values.begin(), unread.parameter_values.end()),
                                  unread.parameter_values.end());
    out_.add(std::move(unread));
  }

  /// False: there is something in it that isn't understood.
  bool read_as(const ReferenceRule& rule, std::string_view options) {
    widths_ = widths_of(rule.widths);
    switch (rule.kind) {
      case RuleKind::set: return read_set(rule.cards.front(), options);
      case RuleKind::contact: return read_contact();
      case RuleKind::initial: return read_initial(rule.cards.front());
      case RuleKind::transformation: return read_transformation(options);
      case RuleKind::nothing:
      case RuleKind::cards: break;
    }
    int headers = 0;
    if (!compile(rule, options, cards_, headers)) return false;
    if (rule.kind == RuleKind::cards) read_cards(headers, rule.once, has_word(options, "ID"));
    return true;
  }

  // --- what cards say ------------------------------------------------------------------------------------------------

  void cut(const Line& line) { card_.cut(line.text, widths_, job_.columns); }

  /// The number in a field; 0 where there is none. What isn't a number, where one is expected, makes the block unclear.
  std::int64_t number(const Card& card, std::size_t field) {
    const std::string_view text = card.text(field);
    if (text.empty()) return 0;
    const std::optional<std::int64_t> value = card.integer(field, parameters_);
    if (!value) unclear_ = true;
    return value.value_or(0);
  }

  std::int64_t with_offset(Referred referred, std::int64_t id) const { return id + offset_of(referred, offsets_); }

  std::uint32_t begin_referrer(std::size_t offset, std::int64_t id, std::string_view title) {
    Referrer referrer;
    referrer.keyword = name_;
    referrer.id = id;
    referrer.title = title;
    referrer.file = job_.file;
    referrer.offset = offset;
    referrer.end = job_.end;
    referrer.style = static_cast<std::uint16_t>(job_.columns);
    return out_.add(std::move(referrer));
  }

  /// Of the cards that have no referrer of their own.
  std::uint32_t referrer() {
    if (!current_) current_ = begin_referrer(job_.keyword, 0, {});
    return *current_;
  }

  void add(Referred referred, ReferenceRole role, std::int64_t first, std::int64_t last, std::int64_t step, std::size_t card) {
    if (first == 0 && last == 0) return;
    Reference reference;
    reference.takes_away = takes_away_;
    reference.referred = referred;
    reference.role = role;
    reference.first = first == 0 ? 0 : with_offset(referred, first);
    reference.last = with_offset(referred, last);
    reference.step = step;
    reference.referrer = referrer();
    reference.card = card;
    out_.add(reference);
  }

  /// A negative id where the manual knows none still is that id to whoever wants to delete it.
  void add(Referred referred, ReferenceRole role, std::int64_t id, std::size_t card) {
    if (id < 0) id = -id;
    add(referred, role, id, id, 1, card);
  }

  void add_all(Referred referred, ReferenceRole role, std::size_t from, const Line& line) {
    for (std::size_t f = from; f < 8; ++f) add(referred, role, number(card_, f), line.offset);
  }

  // --- cards by the table --------------------------------------------------------------------------------------------

  void read_cards(int headers, bool once, bool header_has_id) {
    Line line;
    do {
      set_lines_.clear();
      header_ = {};
      bool any = false;
      for (int i = 0; i < headers; ++i) {
        if (!next(line)) return;
        if (!any) header_ = line;
        any = true;
      }
      own_ = headers > 0;
      header_has_id_ = header_has_id;
      if (own_) current_.reset();
      if (!read_entity()) return;
    } while (!once);
  }

  /// One round through the cards. False: the block is at its end.
  bool read_entity() {
    for (std::size_t c = 0; c < cards_.size(); ++c) {
      const CardRule& card = cards_[c];
      set_lines_.resize(std::max(set_lines_.size(), c));
      if (!is_there(card)) continue;
      std::int64_t times = 1;
      if (card.repeat == CardRule::Repeat::to_the_end) times = kEveryId;
      if (card.repeat == CardRule::Repeat::count) times = value_of(card.count_card, card.count_field);
      if (card.repeat == CardRule::Repeat::group) return read_group(c, value_of(card.count_card, card.count_field));
      for (std::int64_t i = 0; i < times; ++i)
        if (!read_card(c)) return false;
    }
    return true;
  }

  bool read_group(std::size_t first, std::int64_t times) {
    for (std::int64_t i = 0; i < times; ++i)
      for (std::size_t c = first; c < cards_.size(); ++c)
        if (!read_card(c)) return false;
    return true;
  }

  bool read_card(std::size_t c) {
    Line line;
    if (!next(line)) return false;
    set_lines_.resize(std::max(set_lines_.size(), c + 1));
    set_lines_[c] = line.text;
    if (cards_[c].fields.empty()) return true;
    cut(line);
    begin_entity(cards_[c], line);
    for (const FieldRule& field : cards_[c].fields) read_field(field, line);
    return true;
  }

  /// Cards with an id or a title of their own have a referrer of their own.
  void begin_entity(const CardRule& card, const Line& line) {
    std::int64_t id = 0;
    std::optional<Referred> defines;
    for (const FieldRule& field : card.fields) {
      if (field.kind != FieldRule::Kind::own_id && field.kind != FieldRule::Kind::own_part) continue;
      id = number(card_, field.field);
      if (field.kind != FieldRule::Kind::own_part || id <= 0) continue;
      defines = Referred::part;
      id = with_offset(Referred::part, id);
    }
    if (id == 0 && !own_) return;
    std::string_view title = trim(header_.text);
    if (header_has_id_) {
      Card header;
      header.cut(header_.text, job_.columns);
      if (id == 0) id = header.integer(0, parameters_).value_or(0);
      const std::size_t width = job_.columns == Columns::wide ? kWideColumns : 10;
      const std::size_t comma = header_.text.find(',');
      title = trim(header_.text.substr(std::min(comma != std::string_view::npos ? comma + 1 : width, header_.text.size())));
    }
    current_ = begin_referrer(own_ ? header_.offset : line.offset, id, title);
    if (defines) out_.referrer(*current_).defines = defines;
    own_ = false;
  }

  std::int64_t value_of(std::uint8_t card, std::uint8_t field) {
    if (card == 0 || card > set_lines_.size() || field == 0) return 0;
    Card other;
    other.cut(set_lines_[card - 1u], widths_, job_.columns);
    const std::optional<double> value = other.real(field - 1u, parameters_);
    return value && std::abs(*value) < 1e18 ? static_cast<std::int64_t>(*value) : 0;
  }

  bool is_there(const CardRule& card) {
    if (card.condition_card == 0) return true;
    const std::int64_t value = value_of(card.condition_card, card.condition_field);
    const auto& values = card.condition_values;
    return (std::find(values.begin(), values.end(), value) != values.end()) != card.unless;
  }

  void read_field(const FieldRule& field, const Line& line) {
    switch (field.kind) {
      case FieldRule::Kind::own_id:
      case FieldRule::Kind::own_part: return;
      case FieldRule::Kind::range: {
        const std::int64_t first = number(card_, field.field), last = number(card_, field.field + 1u);
        return add(field.referred, last == 0 ? ReferenceRole::single : ReferenceRole::range, first, last == 0 ? first : last, 1,
                   line.offset);
      }
      case FieldRule::Kind::typed: return read_typed(field, line);
      case FieldRule::Kind::id: break;
    }
    const std::int64_t id = number(card_, field.field);
    add(id < 0 && field.has_negative ? field.negative : field.referred, ReferenceRole::single, id, line.offset);
  }

  void read_typed(const FieldRule& field, const Line& line) {
    const std::int64_t id = number(card_, field.field);
    if (id == 0) return;
    Card other;
    if (field.type_card > 0 && field.type_card <= set_lines_.size()) other.cut(set_lines_[field.type_card - 1u], widths_, job_.columns);
    const Card& typed = field.type_card > 0 ? other : card_;
    const char key = type_key(typed, field.type_field - 1u);
    std::size_t at = 0;
    while (at + 1 < field.types.size() && field.types[at] != key && field.types[at] != '_') at += 2;
    Referred referred = Referred::node;
    if (at + 1 >= field.types.size())
      unclear_ = true;
    else if (referred_of(field.types[at + 1], referred))
      add(referred, ReferenceRole::single, id, line.offset);
  }

  char type_key(const Card& card, std::size_t field) const {
    const std::string_view text = card.text(field);
    if (text.empty()) return '0';
    const std::optional<std::int64_t> value = card.integer(field, parameters_);
    if (value) return *value >= 0 && *value <= 9 ? static_cast<char>('0' + *value) : '?';
    std::string word(text);
    word = upper(word);
    return word.find("SET") != std::string::npos ? 'T' : word.front();
  }

  // --- sets ----------------------------------------------------------------------------------------------------------

  bool read_set(char letter, std::string_view options) {
    const bool segments = letter == 'g';
    Referred member = Referred::node, set = Referred::segment_set;
    if (!segments) {
      referred_of(letter, member);
      referred_of(upper(letter), set);
    }
    Line line;
    std::string_view title;
    if (has_word(options, "TITLE")) {
      if (!next(line)) return true;
      title = trim(line.text);
    }
    if (!next(line)) return true;
    cut(line);
    const std::int64_t id = number(card_, 0);
    current_ = begin_referrer(job_.keyword, id > 0 ? with_offset(set, id) : id, title);
    out_.referrer(*current_).defines = set;
    for (std::string_view rest = options; !rest.empty();) {
      rest.remove_prefix(1);
      const std::string_view word = rest.substr(0, std::min(rest.find('_'), rest.size()));
      rest.remove_prefix(word.size());
      constexpr std::string_view kKnown[] = {"LIST", "COLUMN",    "GENERATE", "INCREMENT", "GENERAL",
                                             "ADD",  "INTERSECT", "TITLE",    "COLLECT",   "SMOOTH"};
      if (std::find(std::begin(kKnown), std::end(kKnown), word) == std::end(kKnown)) return false;
    }
    while (next(line)) {
      cut(line);
      if (has_word(options, "GENERAL")) {
        if (!read_general(letter, member, set, line)) return false;
      } else if (has_word(options, "ADD") || has_word(options, "INTERSECT")) {
        read_sets_of_set(set, line);
      } else if (segments) {
        for (std::size_t f = 0; f < 4; ++f) add(Referred::node, ReferenceRole::segment, number(card_, f), line.offset);
      } else {
        read_members(member, options, line);
      }
    }
    return true;
  }

  void read_members(Referred member, std::string_view options, const Line& line) {
    if (has_word(options, "INCREMENT")) return add_range(member, 0, number(card_, 2), line);
    if (has_word(options, "GENERATE")) {
      for (std::size_t f = 0; f < 8; f += 2) add_range(member, f, 1, line);
      return;
    }
    if (has_word(options, "COLUMN")) return add(member, ReferenceRole::list, number(card_, 0), line.offset);
    add_all(member, ReferenceRole::list, 0, line);
  }

  /// A range that ends before it begins, or goes down, is taken as it was meant.
  void add_range(Referred member, std::size_t field, std::int64_t step, const Line& line) {
    std::int64_t first = number(card_, field), last = number(card_, field + 1);
    if (first == 0 && last == 0) return;
    if (last == 0) last = first;
    if (step < 0) step = -step;
    if (last < first) {
      const std::int64_t least = step > 1 ? last + (first - last) % step : last;
      last = std::exchange(first, least);
    }
    add(member, ReferenceRole::range, first, last, std::max<std::int64_t>(step, 1), line.offset);
  }

  /// A negative number means all sets from the one before up to it.
  void read_sets_of_set(Referred set, const Line& line) {
    for (std::size_t f = 0; f < 8; ++f) {
      const std::int64_t id = number(card_, f);
      const std::int64_t before = f > 0 ? number(card_, f - 1) : 0;
      if (id < 0 && before > 0 && before < -id)
        add(set, ReferenceRole::range, before + 1, -id, 1, line.offset);
      else
        add(set, ReferenceRole::list, id, line.offset);
    }
  }

  /// "NODE, 1, 2, 3", "DPART, 4", "ALL"; those with a D take away what they name.
  bool read_general(char letter, Referred member, Referred set, const Line& line) {
    std::string word(card_.text(0));
    word = upper(word);
    takes_away_ = !word.empty() && word.front() == 'D';
    const bool understood = read_general(letter, member, set, word, line);
    takes_away_ = false;
    return understood;
  }

  bool read_general(char letter, Referred member, Referred set, std::string word, const Line& line) {
    if (word.empty()) return true;
    if (word == "ALL") {
      if (letter != 'g') add(member, ReferenceRole::range, 1, kEveryId, 1, line.offset);
      return true;
    }
    const bool takes_away = word.front() == 'D';
    if (takes_away) word.erase(0, 1);
    const ReferenceRole role = takes_away ? ReferenceRole::single : ReferenceRole::list;
    if (word == "PART" || word == "PART_IO") return add_all(Referred::part, ReferenceRole::single, 1, line), true;
    if (word == "BOX" || word.starts_with("BOX_") || word == "VOL" || word.starts_with("VOL_")) return true;
    if (letter == 'g' && word == "SEG") {
      for (std::size_t f = 1; f < 5; ++f) add(Referred::node, takes_away ? role : ReferenceRole::segment, number(card_, f), line.offset);
      return true;
    }
    if (letter == 'n' && word == "NODE") return add_all(Referred::node, role, 1, line), true;
    if (letter == 'p' || letter == 'n' || letter == 'g') return letter == 'g' && word == "SHELL" ? read_shells_of_segments(line) : false;
    if (word == "ELEM" || word == "ELEMENT") return add_all(member, role, 1, line), true;
    if (word == "SET") return add_all(set, role, 1, line), true;
    return false;
  }

  bool read_shells_of_segments(const Line& line) {
    add_all(Referred::shell, ReferenceRole::single, 1, line);
    return true;
  }

  // --- others --------------------------------------------------------------------------------------------------------

  /// In front: a line of the title, then those of MPP (the second begins with '&'); then the surfaces.
  bool read_contact() {
    for (const std::string_view other : {"2D", "ENTITY", "GEBOD", "RIGID_SURFACE", "COUPLING", "AUTO_MOVE", "DRAWBEAD", "ADD_WEAR",
                                         "EXCLUDE_INTERACTION", "GUIDED_CABLE", "WEAR"})
      if (has_word(name_, other)) return false;
    static const ReferenceRule kSurfaces{"", RuleKind::cards, "@3:0G1S2P3p4N5z6P7z @4:0G1S2P3p4N5z6P7z"};
    int headers = 0;
    compile(kSurfaces, {}, cards_, headers);
    Line line;
    const bool has_id = name_.ends_with("_ID") || has_word(name_, "ID");
    if (has_id || has_word(name_, "TITLE")) {
      if (!next(line)) return true;
      header_ = line;
      own_ = true;
      header_has_id_ = true;
    }
    if (has_word(name_, "MPP")) {
      if (!next(line)) return true;
      const Lines before = lines_;
      if (next(line) && (line.text.empty() || line.text.front() != '&')) lines_ = before;
    }
    read_card(0);
    return true;
  }

  /// Only the card with the element has nothing but whole numbers; values are written with a point.
  bool read_initial(char letter) {
    Referred referred = Referred::shell;
    referred_of(letter, referred);
    Line line;
    while (next(line)) {
      if (line.text.find('.') != std::string_view::npos) continue;
      cut(line);
      add(referred, ReferenceRole::single, number(card_, 0), line.offset);
    }
    return true;
  }

  bool read_transformation(std::string_view options) {
    Line line;
    if (has_word(options, "TITLE")) next(line);
    if (!next(line)) return true;
    while (next(line)) {
      cut(line);
      std::string word(card_.text(0));
      word = upper(word);
      const std::size_t nodes = word == "POS6N" ? 6 : word == "TRANSL2ND" ? 2 : word == "ROTATE3NA" ? 2 : 0;
      for (std::size_t f = 1; f <= nodes; ++f) add(Referred::node, ReferenceRole::single, number(card_, f), line.offset);
    }
    return true;
  }

  std::string_view text_;
  const Job& job_;
  const Parameters& parameters_;
  const IdOffsets& offsets_;
  References& out_;
  Lines lines_;
  std::string name_;
  std::optional<Encrypted> encrypted_;
  std::span<const int> widths_ = kTens;
  std::vector<CardRule> cards_;
  Card card_;
  std::vector<std::string_view> set_lines_;  ///< of the entity being read, by card
  Line header_;
  bool own_ = false;         ///< the entity has a header
  bool takes_away_ = false;  ///< the line being read takes out of its set what it names
  bool header_has_id_ = false;
  std::optional<std::uint32_t> current_;
  bool unclear_ = false;
};

bool ReferenceReader::extends_last(const Job& job) const {
  if (jobs_.size() < kMaxUnread || job.rule || job.encrypted) return false;
  const Job& last = jobs_.back();
  return !last.rule && !last.encrypted && last.file == job.file && last.end == job.keyword && last.parameters == job.parameters &&
         last.offsets == job.offsets;
}

void ReferenceReader::read(std::uint32_t file, const Block& block, const Parameters& parameters, const IdOffsets& offsets) {
  if (block.begin >= block.end) return;
  std::string_view options;
  Job job;
  job.rule = find_reference_rule(block.name, options);
  const bool is_mesh = block.name == "NODE" || block.name.starts_with("ELEMENT_");
  if (job.rule && job.rule->kind == RuleKind::nothing && is_mesh) {
    std::vector<CardRule> cards;
    int headers = 0;
    if (compile(*job.rule, options, cards, headers)) return;
  }
  if (parameters_.empty() || !(parameters_.back() == parameters)) parameters_.push_back(parameters);
  if (offsets_.empty() || !(offsets_.back() == offsets)) offsets_.push_back(offsets);
  job.keyword = block.keyword;
  job.begin = block.begin;
  job.end = block.end;
  job.file = file;
  job.parameters = static_cast<std::uint32_t>(parameters_.size() - 1);
  job.offsets = static_cast<std::uint32_t>(offsets_.size() - 1);
  job.name_length = static_cast<std::uint16_t>(block.name.size());
  job.columns = block.columns;
  if (extends_last(job))
    jobs_.back().end = job.end;
  else
    jobs_.push_back(job);
}

void ReferenceReader::encrypted(std::uint32_t file, const Block& block, std::size_t begin, std::size_t end) {
  Block part = block;
  part.begin = begin;
  part.end = end;
  if (parameters_.empty()) parameters_.emplace_back();
  if (offsets_.empty()) offsets_.emplace_back();
  Job job;
  job.keyword = block.keyword;
  job.begin = begin;
  job.end = end;
  job.file = file;
  job.name_length = static_cast<std::uint16_t>(block.name.size());
  job.encrypted = true;
  jobs_.push_back(job);
}

References ReferenceReader::finish(std::span<const SourceFile> files) {
  std::vector<References> parts((jobs_.size() + kJobsAtOnce - 1) / kJobsAtOnce);
  parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t j = p * kJobsAtOnce; j < std::min(jobs_.size(), (p + 1) * kJobsAtOnce); ++j) {
        const Job& job = jobs_[j];
        BlockReader(files[job.file].bytes.text(), job, parameters_[job.parameters], offsets_[job.offsets], parts[p]).run();
      }
  });
  References all;
  for (References& part : parts) all.append(std::move(part));
  jobs_.clear();
  parameters_.clear();
  offsets_.clear();
  return all;
}

}  // namespace prismesh::mesh::deck::lsdyna
