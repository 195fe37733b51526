#include "mesh/model/references.h"

#include <algorithm>
#include <tuple>

namespace prismesh::mesh {
namespace {

auto order(const Reference& r) { return std::make_tuple(r.referred, r.first, r.referrer, r.card); }

}  // namespace

Referred referred(ElementClass element_class) {
  switch (element_class) {
    case ElementClass::shell: return Referred::shell;
    case ElementClass::beam: return Referred::beam;
    case ElementClass::solid: return Referred::solid;
    case ElementClass::tshell: return Referred::tshell;
    case ElementClass::discrete: return Referred::discrete;
    case ElementClass::mass: return Referred::mass;
    case ElementClass::sph: return Referred::sph;
    case ElementClass::other: break;
  }
  return Referred::other;
}

std::string_view name(Referred referred) {
  switch (referred) {
    case Referred::node: return "node";
    case Referred::shell: return "shell";
    case Referred::beam: return "beam";
    case Referred::solid: return "solid";
    case Referred::tshell: return "tshell";
    case Referred::discrete: return "discrete";
    case Referred::mass: return "mass";
    case Referred::sph: return "sph";
    case Referred::other: return "other element";
    case Referred::any_element: return "element";
    case Referred::part: return "part";
    case Referred::node_set: return "node set";
    case Referred::shell_set: return "shell set";
    case Referred::beam_set: return "beam set";
    case Referred::solid_set: return "solid set";
    case Referred::tshell_set: return "tshell set";
    case Referred::discrete_set: return "discrete set";
    case Referred::part_set: return "part set";
    case Referred::segment_set: return "segment set";
    case Referred::element_set: break;
  }
  return "element set";
}

bool same_set(const Referrer& a, const Referrer& b) {
  return &a == &b || (!a.group.empty() && a.id == b.id && a.group == b.group && a.keyword == b.keyword);
}

References References::of(std::vector<Referrer> referrers, std::vector<Reference> references, std::vector<UnreadText> unread) {
  References all;
  all.referrers_ = std::move(referrers);
  all.references_ = std::move(references);
  all.unread_ = std::move(unread);
  all.finish();
  return all;
}

void References::add(Reference reference) {
  if (reference.last < 1 || reference.last < reference.first) return;
  if (reference.step < 1) reference.step = 1;
  if (reference.first < 1) reference.first += (1 - reference.first + reference.step - 1) / reference.step * reference.step;
  if (reference.last < reference.first) return;
  if (!references_.empty() && reference.role == ReferenceRole::list) {
    Reference& before = references_.back();
    if (before.referrer == reference.referrer && before.referred == reference.referred && before.role == reference.role &&
        before.step == 1 && reference.step == 1 && before.last + 1 == reference.first) {
      before.last = reference.last;
      return;
    }
  }
  references_.push_back(reference);
}

void References::append(References&& more) {
  const auto before = static_cast<std::uint32_t>(referrers_.size());
  for (Reference& reference : more.references_) reference.referrer += before;
  std::move(more.referrers_.begin(), more.referrers_.end(), std::back_inserter(referrers_));
  references_.insert(references_.end(), more.references_.begin(), more.references_.end());
  std::move(more.unread_.begin(), more.unread_.end(), std::back_inserter(unread_));
  more = {};
}

void References::finish() {
  const auto less = [](const Reference& a, const Reference& b) { return order(a) < order(b); };
  if (!std::is_sorted(references_.begin(), references_.end(), less)) std::sort(references_.begin(), references_.end(), less);
  reaches_.resize(references_.size());
  for (std::size_t i = 0; i < references_.size(); ++i) {
    const bool same = i > 0 && references_[i - 1].referred == references_[i].referred;
    reaches_[i] = same ? std::max(reaches_[i - 1], references_[i].last) : references_[i].last;
  }
  for (const Referrer& referrer : referrers_)
    if (referrer.defines && referrer.id > 0) defined_.emplace_back(*referrer.defines, referrer.id);
  std::sort(defined_.begin(), defined_.end());
}

std::span<const Reference> References::all(Referred referred) const {
  const auto begin =
      std::partition_point(references_.begin(), references_.end(), [&](const Reference& r) { return r.referred < referred; });
  const auto end = std::partition_point(begin, references_.end(), [&](const Reference& r) { return r.referred == referred; });
  return {references_.data() + (begin - references_.begin()), static_cast<std::size_t>(end - begin)};
}

std::vector<Reference> References::naming(Referred referred, std::int64_t id) const {
  std::vector<Reference> out;
  for (const Referred kind : {referred, Referred::any_element}) {
    if (kind != referred && !is_element(referred)) break;
    const std::span<const Reference> of_kind = all(kind);
    // backwards from the last reference that begins at or before the id, as long as an earlier one may reach it
    auto i = static_cast<std::size_t>(
        std::partition_point(of_kind.begin(), of_kind.end(), [&](const Reference& r) { return r.first <= id; }) - of_kind.begin());
    const std::size_t start = static_cast<std::size_t>(of_kind.data() - references_.data());
    const std::size_t found = out.size();
    for (; i > 0 && reaches_[start + i - 1] >= id; --i)
      if (of_kind[i - 1].names(id)) out.push_back(of_kind[i - 1]);
    std::reverse(out.begin() + static_cast<std::ptrdiff_t>(found), out.end());
    if (referred == Referred::any_element) break;
  }
  return out;
}

bool References::defined(Referred referred, std::int64_t id) const {
  return std::binary_search(defined_.begin(), defined_.end(), std::pair(referred, id));
}

bool References::named(Referred referred, std::int64_t id) const { return !naming(referred, id).empty(); }

}  // namespace prismesh::mesh
