#include "mesh/deck/lsdyna/includes.h"

#include <algorithm>
#include <iterator>

#include "mesh/deck/lsdyna/card.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::lsdyna {
namespace {

constexpr std::size_t kMaxNameLength = 4096;
constexpr std::size_t kMaxPaths = 100;

/// Decks from Windows have backslashes between folders.
std::string with_slashes(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  return name;
}

}  // namespace

bool name_goes_on(std::string_view part) {
  return part.size() >= 2 && part.back() == '+' && (part[part.size() - 2] == ' ' || part[part.size() - 2] == '\t');
}

std::vector<IncludeName> include_names(std::string_view text, const Block& block, bool only_first) {
  std::vector<IncludeName> names;
  Lines lines(text, block.begin, block.end);
  Line line;
  bool is_open = false;
  while (lines.next(line)) {
    std::string_view part = trim(line.text);
    if (part.empty()) continue;
    if (!is_open) {
      if (only_first && !names.empty()) break;
      names.push_back({{}, line.offset});
    }
    is_open = name_goes_on(part);
    if (is_open) part = trim(part.substr(0, part.size() - 1));
    std::string& name = names.back().name;
    if (name.size() + part.size() <= kMaxNameLength) name += part;
  }
  // Some writers put names with blanks between quotes.
  for (IncludeName& each : names) {
    const std::string& name = each.name;
    if (name.size() > 2 && (name.front() == '"' || name.front() == '\'') && name.back() == name.front())
      each.name = name.substr(1, name.size() - 2);
  }
  return names;
}

bool IncludeContext::same_as(const IncludeContext& other) const {
  return parent == other.parent && offsets == other.offsets && mass == other.mass && time == other.time && length == other.length &&
         transformation == other.transformation && prefix == other.prefix && suffix == other.suffix;
}

namespace {

/// Larger offsets fit no field, and their sums must not overflow.
constexpr std::int64_t kMaxOffset = 1'000'000'000'000'000;
constexpr double kMaxFactor = 1e30;
constexpr std::size_t kMaxAffixLength = 256;

/// The fields of an *INCLUDE_TRANSFORM after the file's name.
class TransformCards {
 public:
  TransformCards(const Parameters& parameters, std::string& problem) : parameters_(parameters), problem_(problem) {}

  void read(int number, const Card& card, IncludeContext& context) {
    card_ = &card;
    IdOffsets& to = context.offsets;
    if (number == 1) {
      std::int64_t* const offsets[] = {&to.node, &to.element, &to.part, &to.material, &to.set, &to.function, &to.define};
      for (std::size_t f = 0; f < std::size(offsets); ++f) add_offset(f, *offsets[f]);
    } else if (number == 2) {
      add_offset(0, to.other);
      // The outer include's prefix stands before the inner one's.
      if (!card.text(1).empty()) context.prefix = (context.prefix + std::string(card.text(1)) + ".").substr(0, kMaxAffixLength);
      if (!card.text(2).empty()) context.suffix = ("." + std::string(card.text(2)) + context.suffix).substr(0, kMaxAffixLength);
    } else if (number == 3) {
      context.mass *= factor(0);
      context.time *= factor(1);
      context.own_length = factor(2);
      context.length *= context.own_length;
    } else if (number == 4) {
      context.transformation = card.integer(0, parameters_).value_or(-1);
      if (context.transformation < 0) problem_ = "has a TRANID that can't be read";
    }
  }

 private:
  void add_offset(std::size_t field, std::int64_t& to) {
    const std::optional<std::int64_t> value = card_->integer(field, parameters_);
    if (value && *value > -kMaxOffset && *value < kMaxOffset)
      to += *value;
    else
      problem_ = "has an offset of ids that can't be used";
  }
  double factor(std::size_t field) {
    const std::optional<double> value = card_->real(field, parameters_);
    if (value && *value == 0) return 1;
    if (value && *value > 1 / kMaxFactor && *value < kMaxFactor) return *value;
    problem_ = "has a factor of units that can't be used";
    return 1;
  }

  const Parameters& parameters_;
  std::string& problem_;
  const Card* card_ = nullptr;
};

}  // namespace

IncludeTransform read_transform(std::string_view text, const Block& block, const Parameters& parameters,
                                std::span<const IncludeContext> contexts, std::uint32_t parent) {
  IncludeTransform out{contexts[parent], {}};
  IncludeContext& context = out.context;
  context.parent = parent;
  context.own_length = 1;
  context.transformation = 0;
  Lines lines(text, block.begin, block.end);
  Line line;
  Card card;
  TransformCards cards(parameters, out.problem);
  bool in_name = true;
  for (int number = 0; lines.next(line);) {
    if (in_name) {
      in_name = name_goes_on(trim(line.text)) || trim(line.text).empty();
      continue;
    }
    card.cut(line.text, block.columns);
    cards.read(++number, card, context);
  }
  // Products of factors beyond all units would make positions that aren't finite.
  for (double* const factor : {&context.mass, &context.time, &context.length})
    if (!(*factor > 1 / kMaxFactor && *factor < kMaxFactor)) {
      *factor = 1;
      out.problem = "has a factor of units that can't be used";
    }
  return out;
}

void IncludeSearch::add_path(const std::string& path) {
  if (paths_.size() < kMaxPaths) paths_.push_back(main_folder_ / with_slashes(path));
}

std::vector<std::filesystem::path> IncludeSearch::folders(const std::filesystem::path& from_folder) const {
  std::vector<std::filesystem::path> out = {from_folder, main_folder_};
  out.insert(out.end(), paths_.begin(), paths_.end());
  return out;
}

}  // namespace prismesh::mesh::deck::lsdyna
