#include "mesh/document/contacts.h"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "mesh/contact/contact_surface.h"
#include "mesh/contact/deck_contacts.h"
#include "mesh/contact/find_penetrations.h"
#include "mesh/contact/find_perforations.h"
#include "mesh/contact/joints_of_parts.h"
#include "mesh/contact/perforation_depth.h"
#include "mesh/contact/shell_area.h"
#include "mesh/document/deck_relations.h"
#include "mesh/document/joined_sheets.h"
#include "mesh/select/expression.h"

namespace prismesh::mesh::document {

namespace {

/// Shares of the whole time, as of a million shells of a curved sheet.
constexpr double kTreeBuilt = 0.2, kCrossingsFound = 0.5;

contact::DeckContacts deck_contacts(const Generation& generation) {
  const deck::Deck& deck = *generation.relations->deck;
  return {generation.model, deck.contacts, *deck.references};
}

/// Fills in what regions of both kinds have.
class RegionWriter {
 public:
  /// `surface`: on which they were found.
  RegionWriter(const Generation& generation, const Model& surface, const contact::ContactThickness& thickness)
      : nodes_(generation.model),
        model_(surface),
        thickness_(thickness),
        joints_(model_, joints(generation)),
        contacts_(deck_contacts(generation)) {}

  ContactRegion perforation(const contact::Perforation& found, const contact::PerforationDepth& depth) const {
    ContactRegion region = common("perforation", found.part_a, found.part_b, found.shells_a, found.shells_b);
    region.length = found.length;
    region.max_depth = depth.max;
    region.mean_depth = depth.mean;
    region.area = contact::area_of_smaller(model_, found.shells_a, found.shells_b);
    region.at = depth.deepest.valid() ? model_.position(depth.deepest) : found.curve.front().from;
    const auto& [a, b] = found.crossings.front();
    name_worst(region, a, b);
    region.curve = found.curve;
    for (std::size_t i = 0; i < depth.nearest.size(); ++i) {
      const Vec3& to = depth.nearest[i];
      add_vector(region, depth.entering[i], to - model_.position(depth.entering[i]));
    }
    return region;
  }

  ContactRegion penetration(const contact::Penetration& found) const {
    ContactRegion region =
        common(found.is_clearance ? "clearance" : "penetration", found.part_a, found.part_b, found.shells_a, found.shells_b);
    region.max_depth = found.max_depth;
    region.mean_depth = found.mean_depth;
    region.area = found.area;
    region.at = (found.worst.on_a + found.worst.on_b) / 2;
    name_worst(region, found.worst.a, found.worst.b);
    for (const auto* nodes : {&found.nodes_a, &found.nodes_b})
      for (const contact::WayOut& way : *nodes) add_vector(region, way.node, way.depth * way.direction);
    return region;
  }

 private:
  void add_vector(ContactRegion& region, NodeIndex node, const Vec3& by) const {
    region.vectors.push_back({node, nodes_.position(node) + by, by.norm()});
  }
  std::string shell_name(ShellIndex shell) const { return "shell:" + std::to_string(model_.shell_ids[shell.value]); }
  void name_worst(ContactRegion& region, ShellIndex a, ShellIndex b) const {
    region.worst_a = shell_name(a), region.worst_b = shell_name(b);
    if (const ContactCard* card = contacts_.between(a, b)) region.contact = card->name();
  }
  const Part* part(PartIndex index) const { return index.valid() ? &(*model_.parts)[index.value] : nullptr; }

  ContactRegion common(const char* kind, PartIndex a, PartIndex b, const ShellSet& shells_a, const ShellSet& shells_b) const {
    ContactRegion region;
    region.kind = kind;
    if (const Part* of_a = part(a)) region.a = "part:" + std::to_string(of_a->id), region.name_a = of_a->name;
    if (const Part* of_b = part(b)) region.b = "part:" + std::to_string(of_b->id), region.name_b = of_b->name;
    region.shells_a = shells_a;
    region.shells_b = shells_b;
    region.why = "whether it can be separated isn't computed: the edit separate tries it";
    region.joined = joints_.join_there(a, b, shells_a, shells_b, thickness_);
    const std::string from_a(contact::name(thickness_.from(a))), from_b(contact::name(thickness_.from(b)));
    region.thickness_from = from_a == from_b ? from_a : from_a + ", " + from_b;
    return region;
  }

  const Model& nodes_;
  const Model& model_;
  const contact::ContactThickness& thickness_;
  contact::JointsOfParts joints_;
  contact::DeckContacts contacts_;
};

void write_regions(const RegionWriter& writer, const std::vector<contact::Perforation>& crossed,
                   const std::vector<contact::PerforationDepth>& depths, const std::vector<contact::Penetration>& close,
                   Contacts& contacts) {
  contacts.perforations = crossed.size();
  for (std::size_t i = 0; i < crossed.size(); ++i) contacts.regions.push_back(writer.perforation(crossed[i], depths[i]));
  for (const contact::Penetration& found : close) {
    ++(found.is_clearance ? contacts.clearances : contacts.penetrations);
    contacts.regions.push_back(writer.penetration(found));
  }
}

bool has_any(const ShellSet& shells, const ShellSet& of) {
  return std::any_of(shells.begin(), shells.end(), [&](ShellIndex shell) { return std::binary_search(of.begin(), of.end(), shell); });
}

/// Tells the listener shares of the whole, and remembers whether it stopped the work.
class Share {
 public:
  explicit Share(const Progress& progress) : progress_(progress) {}
  Progress from_to(double from, double to) {
    return [this, from, to](double fraction) {
      stopped_ = stopped_ || (progress_ && !progress_(from + (to - from) * fraction));
      return !stopped_;
    };
  }
  bool stopped() const { return stopped_; }

 private:
  const Progress& progress_;
  bool stopped_ = false;
};

}  // namespace

const spatial::BoxTree& ContactSearch::tree(const Model& model) {
  spatial::BoxTree next;
  if (tree_) {
    next = *tree_;  // where there is no memory in the middle, the old one stays
    next.follow(model);
  } else {
    next = spatial::BoxTree(model);
  }
  tree_ = std::move(next);
  return *tree_;
}

std::shared_ptr<const contact::ContactThickness> ContactSearch::section_thickness(const Model& model) {
  // Removed shells have no thickness, so the corners count, too.
  if (!thickness_ || thickness_of_->parts != model.parts || !same_chunks(thickness_of_->shell_thickness, model.shell_thickness) ||
      !same_chunks(thickness_of_->shell_parts, model.shell_parts) || !same_chunks(thickness_of_->shell_nodes, model.shell_nodes)) {
    thickness_ = std::make_shared<const contact::ContactThickness>(contact::section_thickness(model));
    thickness_of_.emplace();
    thickness_of_->parts = model.parts;
    thickness_of_->shell_thickness = model.shell_thickness;
    thickness_of_->shell_parts = model.shell_parts;
    thickness_of_->shell_nodes = model.shell_nodes;
  }
  return thickness_;
}

std::shared_ptr<const contact::ContactThickness> ContactSearch::thickness(const Generation& generation) {
  const ContactCards& contacts = generation.relations->deck->contacts;
  if (contacts.cards.empty() && contacts.offsets == ContactOffsets::ignored) return section_thickness(generation.model);
  return std::make_shared<const contact::ContactThickness>(contact_thickness(generation));
}

contact::ContactThickness contact_thickness(const Generation& generation) { return deck_contacts(generation).thickness(); }

Result<Contacts> find_contacts(const Generation& generation, ContactSearch& search, const ContactWish& wish, const Progress& progress) {
  if (!std::isfinite(wish.gap) || wish.gap < 0) return fail("contact", "the gap must be a length of at least 0");
  if (wish.thickness && !(std::isfinite(*wish.thickness) && *wish.thickness > 0))
    return fail("contact", "the thickness must be a length above 0");
  ShellSet selected;
  if (wish.select) {
    Result<select::Chosen> chosen =
        select::evaluate(generation.model, *wish.select, select::EntityKind::element, generation.relations->names, progress);
    if (!chosen) return fail(chosen.error());
    selected = std::move(chosen->shells);
    std::sort(selected.begin(), selected.end());
  }
  const ShellSet* only = wish.select ? &selected : nullptr;
  Share share(progress);
  if (!share.from_to(0, 0)(0)) return fail(cancelled());
  const std::shared_ptr<const contact::ContactThickness> thickness =
      wish.thickness     ? std::make_shared<const contact::ContactThickness>(contact::given_thickness(generation.model, *wish.thickness))
      : wish.by_contacts ? search.thickness(generation)
                         : search.section_thickness(generation.model);
  const Model model = thickness->offset.empty() ? generation.model : contact::contact_surface(generation.model, thickness->offset);
  const spatial::BoxTree& tree = search.tree(model);
  const RegionWriter writer(generation, model, *thickness);
  Contacts contacts;
  if (only == nullptr) {
    if (!search.kept().search({model, tree, thickness, wish.gap}, share.from_to(kTreeBuilt, 1))) return fail(cancelled());
    const contact::KeptContacts& kept = search.kept();
    write_regions(writer, kept.perforations(), kept.depths(), kept.penetrations(), contacts);
  } else {
    const std::vector<contact::ShellCrossing> crossings =
        contact::find_shell_crossings(model, tree, nullptr, share.from_to(kTreeBuilt, kCrossingsFound));
    if (share.stopped()) return fail(cancelled());
    const std::vector<contact::Penetration> close =
        contact::find_penetrations(model, tree, *thickness, crossings, {wish.gap, only}, share.from_to(kCrossingsFound, 1));
    if (share.stopped()) return fail(cancelled());
    std::vector<contact::Perforation> crossed = contact::group_crossings(model, crossings);
    std::erase_if(crossed,
                  [&](const contact::Perforation& found) { return !has_any(found.shells_a, *only) && !has_any(found.shells_b, *only); });
    write_regions(writer, crossed, contact::perforation_depths(model, tree, crossed, 0), close, contacts);
  }
  for (const PartIndex part : thickness->without) contacts.without_thickness.push_back((*model.parts)[part.value].id);
  return contacts;
}

}  // namespace prismesh::mesh::document
