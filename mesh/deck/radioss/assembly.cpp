#include "mesh/deck/radioss/assembly.h"

#include <algorithm>
#include <cmath>

#include "mesh/deck/assembly/read_pieces.h"
#include "mesh/deck/radioss/contact_cards.h"
#include "mesh/deck/radioss/references.h"
#include "mesh/deck/radioss/transforms.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::radioss {
namespace {

/// Options of the engine that most of its inputs have.
bool is_engine_word(std::string_view word) {
  static constexpr std::string_view kWords[] = {"RUN", "VERS", "TFILE", "RFILE", "ANIM", "H3D", "STOP", "PRINT", "MON"};
  return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
}

std::optional<LengthUnit> known_length_unit(double metres) {
  if (metres == 1) return LengthUnit::m;
  if (metres == 1e-3) return LengthUnit::mm;
  return std::nullopt;
}

}  // namespace

Result<void> Collected::sort_blocks() {
  const std::string main = walk_.files.files[0].path.string();
  bool begins = false;
  bool engine = false;
  bool starter = false;
  std::vector<Keyword> keywords;
  for (const Block& block : walk_.blocks) {
    const Keyword keyword = keyword_at(walk_.files.files[block.file].bytes.text(), block.offset);
    begins |= keyword.word(0) == "BEGIN";
    engine |= is_engine_word(keyword.word(0));
    starter |= card_form(keyword.word(0)) != nullptr || keyword.word(0) == "PART" || keyword.word(0) == "MAT";
    if (keyword.word(0) == "PARAMETER" && !parameters.read(walk_.files.files, block, keyword))
      walk_.warnings.note("unread-parameter", block.file, block.offset,
                          "a parameter's value is an expression, which isn't worked out; cards that use it are left out");
    if (keyword.word(0) == "UNIT") read_unit_system(block, keyword);
  }
  if (engine && !begins && !starter)
    return fail(main, "is input of the Radioss engine (as in _0001.rad files), not a starter deck; open the _0000.rad file");
  if (walk_.blocks.empty())
    return fail(main, "has no keyword block: fixed-format Radioss input (D00) isn't read; convert it to block format");
  if (!begins && starter)
    walk_.warnings.note("no-begin", 0, 0, "the deck has no /BEGIN, which tells its version; it is read as one of version 51 or later");
  check_submodel_units();
  for (const Block& block : walk_.blocks) {
    const Keyword keyword = keyword_at(walk_.files.files[block.file].bytes.text(), block.offset);
    if (const CardForm* form = card_form(keyword.word(0)))
      add_mesh(block, keyword, *form);
    else
      definitions_.read(block, keyword, tables(walk_.files.files));
    for (const BadField& bad : definitions_.take_bad_fields())
      walk_.warnings.note("bad-card", bad.file, bad.offset, bad.message + "; the card is kept as it is, without that value");
  }
  return {};
}

void Collected::read_unit_system(const Block& block, const Keyword& keyword) {
  BlockLines lines(walk_.files.files, block);
  Line line;
  if (keyword.number(0) <= 0 || !lines.next(line) || !lines.next(line)) return;
  const std::size_t width = walk_.contexts[block.context].field_width();
  const auto mass = unit_factor(field(line.text, width, 0, 2), 'g');
  const auto length = unit_factor(field(line.text, width, 2, 2), 'm');
  const auto time = unit_factor(field(line.text, width, 4, 2), 's');
  if (mass && length && time) systems_.define(block.context, keyword.number(0), {*mass, *length, *time});
}

void Collected::check_submodel_units() {
  for (std::uint32_t c = 1; c < walk_.contexts.size(); ++c)
    if (!tables(walk_.files.files).units(c, 0))
      walk_.warnings.note("undefined-unit", walk_.contexts[c].file, walk_.contexts[c].offset,
                          "a unit system that isn't defined is named; its numbers are taken as they stand");
}

double Collected::length_unit(const Block& block, std::int64_t system) {
  const std::optional<Units> own = tables(walk_.files.files).units(block.context, system);
  const std::optional<Units> main = tables(walk_.files.files).units(0, 0);
  if (!own && system > 0)
    walk_.warnings.note("undefined-unit", block.file, block.offset,
                        "a unit system that isn't defined is named; its numbers are taken as they stand");
  if (!own || !main) return 1;
  const double ratio = own->length / main->length;
  return std::isfinite(ratio) && ratio > 0 ? ratio : 1;
}

std::uint32_t Collected::frame_of(std::uint32_t context, double unit) {
  const auto [at, added] = place_index_.try_emplace({context, unit}, static_cast<std::uint32_t>(places_.size()));
  if (added) places_.emplace_back(context, unit);
  return at->second;
}

void Collected::add_mesh(const Block& block, const Keyword& keyword, const CardForm& form) {
  const Context& context = walk_.contexts[block.context];
  if (form.word == "CNODE")
    walk_.warnings.note("merging-nodes", block.file, block.offset,
                        "nodes of /CNODE are put together with nodes at the same place when the solver starts; they are shown apart");
  const bool nodes = form.kind == CardKind::node;
  const double unit = length_unit(block, form.word == "NODE" ? keyword.number(0) : nodes ? 0 : keyword.number(1));
  Segment segment;
  segment.form = &form;
  segment.old = context.field_width() == kOldField;
  segment.context = block.context;
  segment.frame = frame_of(block.context, nodes ? unit : length_unit(block, 0));
  segment.part = keyword.number(0) > 0 ? keyword.number(0) + context.added.part : 0;
  segment.thickness_unit = unit;
  const auto add = [&](const Stretch& stretch) {
    segment.begin = stretch.begin;
    segment.end = stretch.end;
    add_segment(stretch.file, segment);
  };
  add(block.body);
  for (const Stretch& stretch : block.more) add(stretch);
}

/// Makes pieces of about equal size: cuts long blocks between lines, and joins short ones.
void Collected::add_segment(std::uint32_t file, const Segment& segment) {
  const std::string_view text = walk_.files.files[file].bytes.text();
  const auto bytes_of = [](const Piece& piece) { return piece.segments.back().end - piece.segments.front().begin; };
  const bool single_lines = !segment.form->id_alone && segment.form->nodes[1] == 0;
  Segment rest = segment;
  while (rest.begin < rest.end) {
    // Behind an include the text goes on in the including file, further down; a repeated include starts again at its beginning.
    if (pieces.empty() || pieces.back().file != file || pieces.back().segments.back().end > rest.begin ||
        bytes_of(pieces.back()) >= kPieceBytes)
      pieces.push_back({file, walk_.held[file], {}});
    Piece& piece = pieces.back();
    const std::size_t begin = piece.segments.empty() ? rest.begin : piece.segments.front().begin;
    std::size_t end = rest.end;
    if (single_lines && end - begin > kPieceBytes + kPieceBytes / 2) {
      const std::size_t line_end = text.find('\n', std::max(begin + kPieceBytes, rest.begin));
      end = std::min(rest.end, line_end == std::string_view::npos ? rest.end : line_end + 1);
    }
    Segment part = rest;
    part.end = end;
    piece.segments.push_back(part);
    rest.begin = end;
  }
}

void Collected::complete(DeckContents& found, const std::vector<std::vector<Direction>>& directions) {
  found.parts = definitions_.parts();
  if (const std::optional<Units> main = walk_.contexts[0].units) found.length_unit = known_length_unit(main->length);
  found.frames.resize(places_.size());
  found.id_offsets.resize(places_.size());
  std::vector<std::uint32_t> frame_context(places_.size());
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const auto& [context, unit] = places_[p];
    found.frames[p].to_basic = Eigen::Scaling(unit);
    found.id_offsets[p] = walk_.contexts[context].added;
    frame_context[p] = context;
  }
  std::vector<Transform> transforms;
  std::map<std::int64_t, const Block*> groups;
  ContactReader contacts;
  for (const Block& block : walk_.blocks) {
    const Keyword keyword = keyword_at(found.files[block.file].bytes.text(), block.offset);
    if (card_form(keyword.word(0)) == nullptr) read_references(block, keyword, tables(found.files), found.references);
    contacts.take(block, keyword, tables(found.files));
    if (keyword.word(0) == "TRANSFORM") transforms.push_back(read_transform(block, keyword, tables(found.files)));
    if (keyword.word(0) == "GRNOD") groups.try_emplace(keyword.number(0) + walk_.contexts[block.context].added.set, &block);
  }
  found.contacts = contacts.cards(tables(found.files));
  if (!transforms.empty()) Transformer(found, frame_context, tables(found.files), groups).run(transforms);
  add_directions(found, directions);
  check_positions(found);
}

/// Units and transformations may give positions that aren't finite.
void Collected::check_positions(DeckContents& found) {
  for (PieceCards& cards : found.cards)
    for (std::size_t r = 0; r < cards.node_runs.size() && !cards.error; ++r) {
      const Frame& frame = found.frames[cards.node_runs[r].frame];
      if (frame.is_basic()) continue;
      const std::size_t end = r + 1 < cards.node_runs.size() ? cards.node_runs[r + 1].first : cards.node_id.size();
      for (std::size_t n = cards.node_runs[r].first; n < end && !cards.error; ++n)
        if (!to_basic(frame, cards.position[n]).allFinite())
          cards.error = {cards.node_offset[n], "node " + std::to_string(cards.node_id[n]) + " lies too far away for a number"};
    }
}

void Collected::add_directions(DeckContents& found, const std::vector<std::vector<Direction>>& directions) {
  for (std::size_t p = 0; p < directions.size(); ++p) {
    const CardForm* form = nullptr;
    std::uint32_t referrer = 0;
    for (const Direction& direction : directions[p]) {
      if (direction.form != form) {
        form = direction.form;
        Referrer card;
        card.keyword = std::string(form->word);
        card.file = pieces[p].file;
        card.offset = direction.offset;
        card.end = pieces[p].segments.back().end;
        referrer = found.references.add(std::move(card));
      }
      found.references.add(Reference{Referred::node, ReferenceRole::single, direction.node, direction.node, 1, referrer, direction.offset});
    }
  }
}

}  // namespace prismesh::mesh::deck::radioss
