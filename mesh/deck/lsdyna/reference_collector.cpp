#include "mesh/deck/lsdyna/reference_collector.h"

#include <utility>

namespace prismesh::mesh::deck::lsdyna {
namespace {

std::int64_t offset_of(Referred referred, const IdOffsets& offsets) {
  if (is_set(referred)) return offsets.set;
  if (is_element(referred)) return offsets.element;
  return referred == Referred::node ? offsets.node : offsets.part;
}

}  // namespace

std::int64_t ReferenceCollector::number(const Card& card, std::size_t field) {
  if (card.text(field).empty()) return 0;
  const std::optional<std::int64_t> value = card.integer(field, block_.parameters);
  if (!value) unclear_ = true;
  return value.value_or(0);
}

std::int64_t ReferenceCollector::with_offset(Referred referred, std::int64_t id) const { return id + offset_of(referred, block_.offsets); }

void ReferenceCollector::begin_referrer(const ReferrerCard& card) {
  Referrer referrer;
  referrer.keyword = block_.keyword;
  referrer.id = card.id;
  referrer.title = card.title;
  referrer.file = block_.file;
  referrer.offset = card.offset;
  referrer.end = block_.end;
  referrer.style = static_cast<std::uint16_t>(block_.columns);
  referrer.defines = card.defines;
  current_ = out_.add(std::move(referrer));
}

void ReferenceCollector::add(const NamedIds& ids, std::size_t card) {
  if (ids.first == 0 && ids.last == 0) return;
  if (!current_) begin_referrer({block_.keyword_offset, 0, {}, {}});
  Reference reference;
  reference.takes_away = ids.takes_away;
  reference.referred = ids.referred;
  reference.role = ids.role;
  reference.first = ids.first == 0 ? 0 : with_offset(ids.referred, ids.first);
  reference.last = with_offset(ids.referred, ids.last);
  reference.step = ids.step;
  reference.referrer = *current_;
  reference.card = card;
  out_.add(reference);
}

void ReferenceCollector::add(Referred referred, ReferenceRole role, std::int64_t id, std::size_t card) {
  if (id < 0) id = -id;
  add({referred, role, id, id}, card);
}

}  // namespace prismesh::mesh::deck::lsdyna
