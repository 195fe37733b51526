// Properties and materials of elements.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/nastran/card.h"

namespace prismesh::mesh::deck::nastran {

struct Ply {
  std::int64_t material = 0;
  double thickness = 0;
};

/// The elements that a property is for. Properties of different families may have one number: the element's type tells which is meant.
/// Where one part has several, the first of these families counts: shells are what is shown and weighed.
enum class PropertyFamily : std::uint8_t {
  shell,
  plane,
  solid,
  shear,
  bar,
  beam,
  bend,
  beam3,
  rod,
  tube,
  weld,
  bush,
  bush1d,
  bush2d,
  spring,
  damper,
  mass,
  viscous,
  gap,
  axisymmetric,
  contact
};

struct Property {
  std::int64_t id = 0;
  PropertyFamily family = PropertyFamily::shell;
  std::size_t offset = 0;
  std::optional<std::int64_t> material;
  std::optional<double> thickness;
  std::vector<Ply> plies;  ///< of a laminate that is written out; a symmetric one has its half here
  std::string name;
};

struct Material {
  std::int64_t id = 0;
  std::optional<double> density;
  std::optional<double> youngs_modulus;
  std::optional<double> poissons_ratio;
};

/// What is wrong with the first field of a property or material that should be a number and isn't. nullopt: nothing, or it is neither.
std::optional<std::string> unread_number(const Card& card);

/// What a piece of text defines, in its order.
struct Definitions {
  std::vector<Property> properties;
  std::vector<Material> materials;
  std::vector<std::pair<std::int64_t, std::string>> names;  ///< of properties, from comments of pre-processors

  /// Reads the card if it is a property or a material; false: it is neither.
  bool read(const Card& card, std::size_t offset);
  /// Reads a property's name from a comment line, if it is one of HyperMesh, Femap or ANSA.
  void read_comment(std::string_view line);
  /// Patran's comments give the name of the next property.
  std::string next_name;
};

/// All pieces' definitions together.
class PartTable {
 public:
  /// Of equal ids of a family the first counts. True: the family had a property with this id before.
  bool add(const Property& property);
  void add(const Material& material) { materials_.try_emplace(material.id, material); }
  void add_name(std::int64_t id, const std::string& name) { names_.try_emplace(id, name); }

  std::vector<Part> parts() const;
  /// Of a property of shells.
  std::optional<double> thickness_of(std::int64_t property) const;

 private:
  void put_in(const Property& property, Part& part) const;

  std::map<std::pair<std::int64_t, PropertyFamily>, Property> properties_;
  std::map<std::int64_t, Material> materials_;
  std::map<std::int64_t, std::string> names_;
};

}  // namespace prismesh::mesh::deck::nastran
