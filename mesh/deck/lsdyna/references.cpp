#include "mesh/deck/lsdyna/references.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string>
#include <utility>

#include "base/letter_case.h"
#include "base/parallel_for.h"
#include "mesh/deck/lsdyna/block_lines.h"
#include "mesh/deck/lsdyna/card_references.h"
#include "mesh/deck/lsdyna/reference_collector.h"
#include "mesh/deck/lsdyna/reference_tables.h"
#include "mesh/deck/lsdyna/set_references.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::array<int, 8> kTens = {10, 10, 10, 10, 10, 10, 10, 10};
constexpr std::array<int, 10> kEights = {8, 8, 8, 8, 8, 8, 8, 8, 8, 8};
constexpr std::array<int, 6> kMoves = {8, 16, 16, 16, 8, 8};

/// From this many blocks on, those that nobody understands and that follow each other are joined, so that a deck of nothing else stays
/// small.
constexpr std::size_t kMaxUnread = 4096;

/// How many blocks a thread takes at a time.
constexpr std::size_t kBlocksAtOnce = 64;

std::span<const int> widths_of(const ReferenceRule* rule) {
  switch (rule ? rule->widths : FieldWidths::tens) {
    case FieldWidths::eights: return kEights;
    case FieldWidths::moves: return kMoves;
    case FieldWidths::tens: break;
  }
  return kTens;
}

/// The whole numbers that parameters stand for in text[begin, end), ascending, each once, without their signs.
std::vector<std::int64_t> parameter_values(std::string_view text, std::size_t begin, std::size_t end, const Parameters& parameters) {
  std::vector<std::int64_t> values;
  for (std::size_t at = text.find('&', begin); at < end; at = text.find('&', at + 1)) {
    std::size_t last = at + 1;
    while (last < end && (std::isalnum(static_cast<unsigned char>(text[last])) || text[last] == '_')) ++last;
    const std::optional<std::int64_t> value = parameters.integer(text.substr(at, last - at));
    if (value) values.push_back(*value < 0 ? -*value : *value);
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

/// Text that nobody understands. Without the values of its parameters a search of the text for an id would miss them.
void add_unread(const ReferenceBlock& block, References& out) {
  out.add(UnreadText{block.keyword, block.file, block.keyword_offset, block.end, false,
                     parameter_values(block.text, block.keyword_offset, block.end, block.parameters)});
}

void add_encrypted(const ReferenceBlock& block, const EncryptedPart& part, References& out) {
  out.add(UnreadText{block.keyword, block.file, part.begin, part.end, true, {}});
}

/// The letter says which elements. Only the card with the element has nothing but whole numbers; values are written with a point.
void read_initial_references(BlockLines& lines, char letter, ReferenceCollector& out) {
  Referred referred = Referred::shell;
  referred_of(letter, referred);
  Line line;
  Card card;
  while (lines.next(line)) {
    if (line.text.find('.') != std::string_view::npos) continue;
    out.cut(line, card);
    out.add(referred, ReferenceRole::single, out.number(card, 0), line.offset);
  }
}

void read_transformation_references(BlockLines& lines, std::string_view options, ReferenceCollector& out) {
  Line line;
  if (has_word(options, "TITLE")) lines.next(line);
  if (!lines.next(line)) return;
  Card card;
  while (lines.next(line)) {
    out.cut(line, card);
    const std::string word = upper(card.text(0));
    const std::size_t nodes = word == "POS6N" ? 6 : word == "TRANSL2ND" ? 2 : word == "ROTATE3NA" ? 2 : 0;
    for (std::size_t f = 1; f <= nodes; ++f) out.add(Referred::node, ReferenceRole::single, out.number(card, f), line.offset);
  }
}

/// False: there is something in it that isn't understood.
bool read_by_rule(BlockLines& lines, const ReferenceRule& rule, std::string_view options, ReferenceCollector& out) {
  switch (rule.kind) {
    case RuleKind::set: return read_set_references(lines, rule.cards.front(), options, out);
    case RuleKind::contact: return read_contact_references(lines, out);
    case RuleKind::initial: return read_initial_references(lines, rule.cards.front(), out), true;
    case RuleKind::transformation: return read_transformation_references(lines, options, out), true;
    case RuleKind::nothing:
    case RuleKind::cards: break;
  }
  return read_card_references(lines, rule, options, out);
}

/// `rule`: null where nobody understands the block. What stands behind an encrypted part is read as if the part weren't there.
void read_block(const ReferenceBlock& block, const ReferenceRule* rule, References& out) {
  const std::vector<EncryptedPart> encrypted = encrypted_parts(block.text, block.begin, block.end);
  // The walk reports those among elements.
  if (!block.keyword.starts_with("ELEMENT_"))
    for (const EncryptedPart& part : encrypted) add_encrypted(block, part, out);
  if (!rule) return add_unread(block, out);
  BlockLines lines(block.text, block.begin, block.end, encrypted);
  ReferenceCollector collector(block, out);
  const std::string_view options = std::string_view(block.keyword).substr(rule->keyword.size());
  const bool understood = read_by_rule(lines, *rule, options, collector);
  if (!understood || rule->partly || collector.unclear()) add_unread(block, out);
}

/// The keyword of a block, of which the name's length is known.
std::string keyword_of(std::string_view text, std::size_t keyword, std::size_t name_length) {
  const std::size_t end = std::min(text.find('\n', keyword), text.size());
  return upper(trim(text.substr(keyword + 1, end - keyword - 1)).substr(0, name_length));
}

}  // namespace

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

void ReferenceReader::read_job(const Job& job, std::string_view text, References& out) const {
  const ReferenceBlock block{text,
                             job.file,
                             keyword_of(text, job.keyword, job.name_length),
                             job.keyword,
                             job.begin,
                             job.end,
                             job.columns,
                             widths_of(job.rule),
                             parameters_[job.parameters],
                             offsets_[job.offsets]};
  if (job.encrypted)
    add_encrypted(block, {job.begin, job.end}, out);
  else
    read_block(block, job.rule, out);
}

References ReferenceReader::finish(std::span<const SourceFile> files) {
  std::vector<References> parts((jobs_.size() + kBlocksAtOnce - 1) / kBlocksAtOnce);
  parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (std::size_t j = p * kBlocksAtOnce; j < std::min(jobs_.size(), (p + 1) * kBlocksAtOnce); ++j)
        read_job(jobs_[j], files[jobs_[j].file].bytes.text(), parts[p]);
  });
  References all;
  for (References& part : parts) all.append(std::move(part));
  jobs_.clear();
  parameters_.clear();
  offsets_.clear();
  return all;
}

}  // namespace prismesh::mesh::deck::lsdyna
