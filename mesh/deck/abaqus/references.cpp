#include "mesh/deck/abaqus/references.h"

#include <algorithm>
#include <array>

#include "mesh/deck/abaqus/instance_shifts.h"
#include "mesh/deck/text/number.h"

namespace prismesh::mesh::deck::abaqus {
namespace {

/// What a keyword's data lines name. Names of sets among them need no entry: the set itself has one.
enum class Shape : std::uint8_t {
  nothing,    ///< nothing by number
  nset,       ///< *NSET
  elset,      ///< *ELSET
  node,       ///< the first field of each line is a node
  element,    ///< ... an element
  node_list,  ///< every field of every line is one
  element_list,
  after_word,    ///< a word, then nodes (*MPC)
  equation,      ///< a count, then node, degree of freedom and factor, over and over
  surface,       ///< nodes or elements by TYPE=
  initial,       ///< nodes or elements by TYPE=
  element_node,  ///< an element, then a node (*NORMAL)
  two_nodes,     ///< two nodes
};

struct Rule {
  std::string_view word;
  Shape shape;
};

/// Ascending by word.
constexpr Rule kRules[] = {
    {"ACOUSTIC FLOW VELOCITY", Shape::node},
    {"AMPLITUDE", Shape::nothing},
    {"ASSEMBLY", Shape::nothing},
    {"BASE MOTION", Shape::nothing},
    {"BEAM GENERAL SECTION", Shape::nothing},
    {"BEAM SECTION", Shape::nothing},
    {"BOUNDARY", Shape::node},
    {"BUCKLE", Shape::nothing},
    {"BULK VISCOSITY", Shape::nothing},
    {"CFILM", Shape::node},
    {"CFLUX", Shape::node},
    {"CHANGE FRICTION", Shape::nothing},
    {"CLEARANCE", Shape::nothing},
    {"CLOAD", Shape::node},
    {"COHESIVE SECTION", Shape::nothing},
    {"COMPLEX FREQUENCY", Shape::nothing},
    {"CONDUCTIVITY", Shape::nothing},
    {"CONNECTOR BEHAVIOR", Shape::nothing},
    {"CONNECTOR DAMPING", Shape::nothing},
    {"CONNECTOR ELASTICITY", Shape::nothing},
    {"CONNECTOR LOAD", Shape::element},
    {"CONNECTOR MOTION", Shape::element},
    {"CONNECTOR SECTION", Shape::nothing},
    {"CONTACT", Shape::nothing},
    {"CONTACT CONTROLS", Shape::nothing},
    {"CONTACT DAMPING", Shape::nothing},
    {"CONTACT FILE", Shape::nothing},
    {"CONTACT INCLUSIONS", Shape::nothing},
    {"CONTACT OUTPUT", Shape::nothing},
    {"CONTACT PAIR", Shape::nothing},
    {"CONTACT PRINT", Shape::nothing},
    {"CONTACT PROPERTY ASSIGNMENT", Shape::nothing},
    {"CONTROLS", Shape::nothing},
    {"CORRELATION", Shape::nothing},
    {"COUPLED TEMPERATURE-DISPLACEMENT", Shape::nothing},
    {"COUPLING", Shape::nothing},

    {"CRADIATE", Shape::node},
    {"CREEP", Shape::nothing},
    {"CYCLIC SYMMETRY MODEL", Shape::nothing},
    {"DAMAGE EVOLUTION", Shape::nothing},
    {"DAMAGE INITIATION", Shape::nothing},
    {"DAMPING", Shape::nothing},
    {"DASHPOT", Shape::nothing},
    {"DENSITY", Shape::nothing},
    {"DEPVAR", Shape::nothing},
    {"DFLUX", Shape::element},
    {"DISTRIBUTING", Shape::nothing},
    {"DISTRIBUTION", Shape::element},
    {"DISTRIBUTION TABLE", Shape::nothing},
    {"DLOAD", Shape::element},
    {"DSFLUX", Shape::nothing},
    {"DSLOAD", Shape::nothing},
    {"DYNAMIC", Shape::nothing},
    {"EL FILE", Shape::nothing},
    {"EL PRINT", Shape::nothing},
    {"ELASTIC", Shape::nothing},
    {"ELEMENT OUTPUT", Shape::nothing},
    {"ELSET", Shape::elset},
    {"EMBEDDED ELEMENT", Shape::element_list},
    {"END ASSEMBLY", Shape::nothing},
    {"END INSTANCE", Shape::nothing},
    {"END LOAD CASE", Shape::nothing},
    {"END PART", Shape::nothing},
    {"END STEP", Shape::nothing},
    {"ENERGY OUTPUT", Shape::nothing},
    {"ENERGY PRINT", Shape::nothing},
    {"EQUATION", Shape::equation},
    {"EXPANSION", Shape::nothing},
    {"FASTENER", Shape::nothing},
    {"FASTENER PROPERTY", Shape::nothing},
    {"FIELD", Shape::node},
    {"FILE FORMAT", Shape::nothing},
    {"FILM", Shape::element},
    {"FIXED MASS SCALING", Shape::nothing},
    {"FLUID CONSTANTS", Shape::nothing},
    {"FLUID SECTION", Shape::nothing},
    {"FREQUENCY", Shape::nothing},
    {"FRICTION", Shape::nothing},
    {"GAP", Shape::nothing},
    {"GAP CONDUCTANCE", Shape::nothing},
    {"HEADING", Shape::nothing},
    {"HEAT TRANSFER", Shape::nothing},
    {"HOURGLASS STIFFNESS", Shape::nothing},
    {"HYPERELASTIC", Shape::nothing},
    {"INCIDENT WAVE", Shape::nothing},
    {"INITIAL CONDITIONS", Shape::initial},
    {"INSTANCE", Shape::nothing},
    {"KINEMATIC", Shape::nothing},
    {"LOAD CASE", Shape::nothing},
    {"MASS", Shape::nothing},
    {"MASS FLOW RATE", Shape::node},
    {"MATERIAL", Shape::nothing},
    {"MEMBRANE SECTION", Shape::nothing},
    {"MODAL DAMPING", Shape::nothing},
    {"MODAL DYNAMIC", Shape::nothing},
    {"MODEL CHANGE", Shape::element_list},
    {"MONITOR", Shape::nothing},
    {"MPC", Shape::after_word},
    {"NO COMPRESSION", Shape::nothing},
    {"NO TENSION", Shape::nothing},
    {"NODAL THICKNESS", Shape::node},
    {"NODE FILE", Shape::nothing},
    {"NODE OUTPUT", Shape::nothing},
    {"NODE PRINT", Shape::nothing},
    {"NONSTRUCTURAL MASS", Shape::nothing},
    {"NORMAL", Shape::element_node},
    {"NSET", Shape::nset},
    {"ORIENTATION", Shape::nothing},
    {"OUTPUT", Shape::nothing},
    {"PART", Shape::nothing},
    {"PHYSICAL CONSTANTS", Shape::nothing},
    {"PLASTIC", Shape::nothing},
    {"PRE-TENSION SECTION", Shape::nothing},
    {"PREPRINT", Shape::nothing},
    {"PRESSURE STRESS", Shape::node},
    {"RADIATE", Shape::element},
    {"RATE DEPENDENT", Shape::nothing},
    {"RELEASE", Shape::element},
    {"RESTART", Shape::nothing},
    {"RIGID BODY", Shape::nothing},
    {"ROTARY INERTIA", Shape::nothing},
    {"SECTION CONTROLS", Shape::nothing},
    {"SHELL GENERAL SECTION", Shape::nothing},
    {"SHELL SECTION", Shape::nothing},
    {"SOLID SECTION", Shape::nothing},
    {"SOLVER CONTROLS", Shape::nothing},
    {"SPECIFIC HEAT", Shape::nothing},
    {"SPRING", Shape::nothing},
    {"STATIC", Shape::nothing},
    {"STEADY STATE DYNAMICS", Shape::nothing},
    {"STEP", Shape::nothing},
    {"SURFACE", Shape::surface},
    {"SURFACE BEHAVIOR", Shape::nothing},
    {"SURFACE INTERACTION", Shape::nothing},
    {"SURFACE SECTION", Shape::nothing},
    {"TEMPERATURE", Shape::node},
    {"TIE", Shape::nothing},
    {"TIME POINTS", Shape::nothing},
    {"TRANSFORM", Shape::nothing},
    {"TRANSVERSE SHEAR STIFFNESS", Shape::nothing},
    {"UNCOUPLED TEMPERATURE-DISPLACEMENT", Shape::nothing},
    {"USER MATERIAL", Shape::nothing},
    {"VALUES AT INFINITY", Shape::nothing},
    {"VIEWFACTOR", Shape::nothing},
    {"VISCO", Shape::nothing},
};
constexpr bool ascending() {
  for (std::size_t i = 1; i < std::size(kRules); ++i)
    if (!(kRules[i - 1].word < kRules[i].word)) return false;
  return true;
}

/// Parameters of any keyword that may name a node or an element by its number.
constexpr std::string_view kNodeParameters[] = {"REFNODE", "NODE", "ROTNODE", "CONTROLNODE", "PILOT", "NSET", "PINNSET", "TIENSET"};
constexpr std::string_view kElementParameters[] = {"ELEMENT"};

/// What *INITIAL CONDITIONS of these types are given for.
constexpr std::string_view kInitialOfNodes[] = {"ACOUSTIC",      "CONCENTRATION",   "DISPLACEMENT",      "FIELD",      "MASS FLOW RATE",
                                                "PORE PRESSURE", "PRESSURE STRESS", "ROTATING VELOCITY", "SATURATION", "TEMPERATURE",
                                                "VELOCITY",      "FLUID VELOCITY",  "TOTAL PRESSURE"};

class Finder {
 public:
  explicit Finder(const DeckOutline& outline) : outline_(outline) { static_assert(ascending()); }

  References run() {
    for (const std::string& word : outline_.words) {
      const auto at = std::lower_bound(std::begin(kRules), std::end(kRules), word,
                                       [](const Rule& rule, const std::string& w) { return rule.word < w; });
      rules_.push_back(at != std::end(kRules) && at->word == word ? &*at : nullptr);
    }
    for (const KeptBlock& kept : outline_.kept) read(kept);
    return std::move(out_);
  }

 private:
  void read(const KeptBlock& kept) {
    const Rule* rule = rules_[kept.word];
    const Block& block = kept.block;
    if (!rule) {
      for (std::uint32_t s = 0; s < std::max(block.segments, 1u); ++s) {
        const Segment where = s < block.segments ? outline_.segments[block.first_segment + s] : Segment{block.file, block.end, block.end};
        out_.add(UnreadText{outline_.words[kept.word], where.file, s == 0 && where.file == block.file ? block.begin : where.begin,
                            where.end, false});
      }
      return;
    }
    const Parameters given = outline_.parameters(block);
    for (const std::int64_t shift : shifts_of(outline_, block, given)) read_for(kept, *rule, given, shift);
  }

  void read_for(const KeptBlock& kept, const Rule& rule, const Parameters& given, std::int64_t shift) {
    block_ = &kept.block;
    word_ = rule.word;
    shift_ = shift;
    referrer_ = kNone;
    given_ = &given;
    for (const std::string_view name : kNodeParameters)
      if (const auto value = given.value(name)) add(Referred::node, ReferenceRole::single, *value, kept.block.begin);
    for (const std::string_view name : kElementParameters)
      if (const auto value = given.value(name)) add(Referred::any_element, ReferenceRole::single, *value, kept.block.begin);
    if (rule.shape == Shape::nothing) return;
    const bool set = rule.shape == Shape::nset || rule.shape == Shape::elset;
    // An empty set counts: new ids may join it.
    if (set) referrer();
    equation_left_ = 0;
    for (std::uint32_t s = 0; s < kept.block.segments; ++s) {
      const Segment& where = outline_.segments[kept.block.first_segment + s];
      // The lines of a set stay together; others are told by the file that they stand in.
      if (!set && where.file != (segment_ != nullptr ? segment_->file : kept.block.file)) referrer_ = kNone;
      segment_ = &where;
      DataLines lines(outline_.text(where.file), where.begin, where.end);
      for (DataLine line; lines.next(line);) read_line(rule.shape, line);
    }
    segment_ = nullptr;
  }

  void read_line(Shape shape, const DataLine& line) {
    const auto fields = first_fields<3>(line.text);
    switch (shape) {
      case Shape::nothing: return;
      case Shape::nset:
      case Shape::elset: return read_set_line(shape == Shape::nset ? Referred::node : Referred::any_element, line);
      case Shape::node: return add(Referred::node, ReferenceRole::single, fields[0], line.offset);
      case Shape::element: return add(Referred::any_element, ReferenceRole::single, fields[0], line.offset);
      case Shape::surface:
        return add(label(given_->value("TYPE").value_or("ELEMENT")) == "NODE" ? Referred::node : Referred::any_element,
                   ReferenceRole::single, fields[0], line.offset);
      case Shape::initial: {
        const std::string type = label(given_->value("TYPE").value_or(""));
        const bool nodes = std::find(std::begin(kInitialOfNodes), std::end(kInitialOfNodes), type) != std::end(kInitialOfNodes);
        return add(nodes ? Referred::node : Referred::any_element, ReferenceRole::single, fields[0], line.offset);
      }
      case Shape::element_node:
        add(Referred::any_element, ReferenceRole::single, fields[0], line.offset);
        return add(Referred::node, ReferenceRole::single, fields[1], line.offset);
      case Shape::two_nodes:
        add(Referred::node, ReferenceRole::single, fields[0], line.offset);
        return add(Referred::node, ReferenceRole::single, fields[1], line.offset);
      case Shape::node_list: return read_all(Referred::node, line, 0);
      case Shape::element_list: return read_all(Referred::any_element, line, 0);
      case Shape::after_word: return read_all(Referred::node, line, 1);
      case Shape::equation: return read_equation_line(line);
    }
  }

  void read_all(Referred referred, const DataLine& line, std::size_t from) {
    Fields fields(line.text);
    std::string_view field;
    for (std::size_t f = 0; fields.next(field); ++f)
      if (f >= from) add(referred, ReferenceRole::single, field, line.offset);
  }

  void read_set_line(Referred referred, const DataLine& line) {
    if (!given_->has("GENERATE")) {
      Fields fields(line.text);
      for (std::string_view field; fields.next(field);) add(referred, ReferenceRole::list, field, line.offset);
      return;
    }
    const auto fields = first_fields<3>(line.text);
    Reference range;
    range.referred = referred;
    range.role = ReferenceRole::range;
    if (!parse_integer(fields[0], range.first) || !parse_integer(fields[1], range.last) || !parse_integer(fields[2], range.step)) return;
    if (fields[1].empty()) range.last = range.first;
    add(range, line.offset);
  }

  /// A count of terms on a line, then as many times "node, degree of freedom, factor", on any number of lines.
  void read_equation_line(const DataLine& line) {
    Fields fields(line.text);
    std::string_view field;
    if (equation_left_ == 0) {
      if (fields.next(field) && parse_integer(field, equation_left_))
        equation_left_ = std::clamp<std::int64_t>(equation_left_, 0, 1'000'000'000);
      return;
    }
    for (std::int64_t f = 0; equation_left_ > 0 && fields.next(field); ++f) {
      if (f % 3 == 0) add(Referred::node, ReferenceRole::single, field, line.offset);
      if (f % 3 == 2) --equation_left_;
    }
  }

  void add(Referred referred, ReferenceRole role, std::string_view field, std::size_t offset) {
    Reference reference;
    reference.referred = referred;
    reference.role = role;
    // A node of an instance, from outside of it: "part-1-1.35".
    const std::size_t point = field.rfind('.');
    std::int64_t shift = shift_;
    if (point != std::string_view::npos && point > 0 && !outline_.instances.empty() && block_->scope == 0) {
      const auto at = outline_.instance_by_name.find(label(field.substr(0, point)));
      if (at != outline_.instance_by_name.end()) {
        shift = outline_.instances[at->second].shift;
        field.remove_prefix(point + 1);
      }
    }
    if (field.empty() || !parse_integer(field, reference.first) || reference.first <= 0) return;
    reference.last = reference.first;
    std::swap(shift, shift_);
    add(reference, offset);
    std::swap(shift, shift_);
  }

  void add(Reference reference, std::size_t offset) {
    reference.first += shift_;
    reference.last += shift_;
    reference.referrer = referrer();
    reference.card = offset;
    out_.add(reference);
  }

  /// Made when the first entity is named.
  std::uint32_t referrer() {
    if (referrer_ != kNone) return referrer_;
    Referrer card;
    card.keyword = std::string(word_);
    const std::string_view name_of = word_ == "NSET" ? "NSET" : word_ == "ELSET" ? "ELSET" : "NAME";
    card.title = std::string(given_->value(name_of).value_or(""));
    card.file = block_->file;
    card.offset = block_->begin;
    card.end = block_->end;
    const bool is_elsewhere = segment_ != nullptr && segment_->file != block_->file && word_ != "NSET" && word_ != "ELSET";
    if (is_elsewhere) {
      card.file = segment_->file;
      card.offset = segment_->begin;
      card.end = segment_->end;
    } else if (block_->segments > 0)
      if (const Segment& first = outline_.segments[block_->first_segment]; first.file == block_->file) card.end = first.end;
    // A data file that several keywords name can't be changed for one of them.
    const bool is_shared = is_elsewhere && outline_.is_shared(segment_->file);
    const bool other_ids = is_shared || shift_ != 0 || (block_->scope > 0 && outline_.scopes[block_->scope].instances.size() > 1);
    card.style = static_cast<std::uint16_t>((given_->has("GENERATE") ? kStyleGenerate : 0) | (other_ids ? kStyleOtherIds : 0) |
                                            (word_ == "NSET" || word_ == "ELSET" ? 0 : kStyleNamesAndIds));
    return referrer_ = out_.add(std::move(card));
  }

  const DeckOutline& outline_;
  References out_;
  std::vector<const Rule*> rules_;  ///< by word
  const Block* block_ = nullptr;
  std::string_view word_;
  const Parameters* given_ = nullptr;
  const Segment* segment_ = nullptr;  ///< being read
  std::int64_t shift_ = 0;
  std::uint32_t referrer_ = kNone;
  std::int64_t equation_left_ = 0;  ///< terms of the current equation that follow
};

}  // namespace

References find_references(const DeckOutline& outline) { return Finder(outline).run(); }

}  // namespace prismesh::mesh::deck::abaqus
