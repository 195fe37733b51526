#include "kiosk/display/kms/link.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace prismesh::kiosk::display::kms {
namespace {

enum class Owner : std::uint8_t { connector, crtc, plane };

constexpr std::uint64_t kBitsAColour = 8;  ///< as many as the picture has: with fewer or more the link may dither

/// How the value of a rule is found.
struct Rule {
  Owner owner = Owner::connector;
  std::string_view what;
  std::string_view property;
  std::string_view value;  ///< a name of the enumeration; "0": none; "max": the range's end; "8": that number, within the range
  bool told = false;       ///< a driver without it leaves open what it does
};

/// Drivers name some properties differently; the rule for each name stands by itself.
constexpr std::array kRules{
    Rule{Owner::connector, "scaling", "scaling mode", "None"},
    Rule{Owner::connector, "underscan", "underscan", "off"},
    Rule{Owner::connector, "bits a colour", "max bpc", "8", true},
    Rule{Owner::connector, "colour range", "Broadcast RGB", "Full", true},
    Rule{Owner::connector, "dithering", "dithering mode", "off", true},
    Rule{Owner::connector, "dithering", "dither", "off", true},
    Rule{Owner::connector, "colour space", "Colorspace", "Default"},
    Rule{Owner::connector, "kind of content", "content type", "Graphics"},
    Rule{Owner::connector, "colour format", "color format", "rgb", true},
    Rule{Owner::connector, "colour format", "color_format", "rgb", true},
    Rule{Owner::crtc, "colour matrix", "CTM", "0"},
    Rule{Owner::crtc, "linear table", "DEGAMMA_LUT", "0"},
    Rule{Owner::crtc, "gamma table", "GAMMA_LUT", "0"},
    Rule{Owner::crtc, "variable refresh rate", "VRR_ENABLED", "0"},
    Rule{Owner::plane, "rotation", "rotation", "rotate-0"},
    Rule{Owner::plane, "opacity", "alpha", "max"},
    Rule{Owner::plane, "blending", "pixel blend mode", "None"},
};

std::string lower(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// A driver writes the names of values in its own case ("Off", "off").
std::optional<std::uint64_t> value_in_any_case(const Property& property, std::string_view name) {
  for (const auto& [known, value] : property.names)
    if (lower(known) == lower(std::string(name))) return value;
  return std::nullopt;
}

std::optional<std::uint64_t> wanted_value(const Rule& rule, const Property& property) {
  if (rule.value == "0") return 0;
  if (rule.value == "max") return property.high > property.low ? std::optional(property.high) : std::nullopt;
  if (rule.value == "8")
    return property.high > property.low ? std::optional(std::clamp(kBitsAColour, property.low, property.high)) : std::nullopt;
  return value_in_any_case(property, rule.value);
}

template <class Objects>
const Properties* properties_of(const Objects& objects, ObjectId id) {
  const auto found = std::find_if(objects.begin(), objects.end(), [&](const auto& one) { return one.id == id; });
  return found == objects.end() ? nullptr : &found->properties;
}

struct Subject {
  ObjectId id = 0;
  const Properties* properties = nullptr;
};

Subject owner_of(const Rule& rule, const CardState& card, const Output& output) {
  switch (rule.owner) {
    case Owner::connector: return {output.connector.id, properties_of(card.connectors, output.connector.id)};
    case Owner::crtc: return {output.crtc, properties_of(card.crtcs, output.crtc)};
    case Owner::plane: return {output.plane, properties_of(card.planes, output.plane)};
  }
  return {};
}

const Property* property_of(const Rule& rule, const CardState& card, const Output& output) {
  const Properties* properties = owner_of(rule, card, output).properties;
  if (properties == nullptr) return nullptr;
  const auto found = properties->find(rule.property);
  return found == properties->end() ? nullptr : &found->second;
}

std::string text_of_value(const Property& property, std::uint64_t value) {
  Property other = property;
  other.value = value;
  return other.value_text();
}

/// Rotation is a bit mask with one bit set, whose names stand for the bits.
bool is_turned(const CardState& card, const Output& output) {
  const Properties* plane = properties_of(card.planes, output.plane);
  const auto rotation = plane != nullptr ? plane->find("rotation") : Properties::const_iterator();
  if (plane == nullptr || rotation == plane->end()) return false;
  const std::optional<std::uint64_t> upright = rotation->second.value_named("rotate-0");
  return upright && rotation->second.value != *upright;
}

void add_once(std::vector<std::string>& list, std::string_view what) {
  if (std::find(list.begin(), list.end(), what) == list.end()) list.emplace_back(what);
}

}  // namespace

std::vector<LinkWish> link_wishes(const CardState& card, const Output& output) {
  std::vector<LinkWish> wishes;
  for (const Rule& rule : kRules) {
    const Property* property = property_of(rule, card, output);
    if (property == nullptr || property->fixed) continue;
    if (const std::optional<std::uint64_t> value = wanted_value(rule, *property))
      wishes.push_back({std::string(rule.what),
                        std::string(rule.property),
                        {owner_of(rule, card, output).id, property->id, *value},
                        text_of_value(*property, *value)});
  }
  return wishes;
}

LinkFacts read_link(const CardState& card, const Output& output) {
  LinkFacts facts;
  std::vector<std::string> told;
  for (const Rule& rule : kRules) {
    const Property* property = property_of(rule, card, output);
    if (property == nullptr) continue;
    told.emplace_back(rule.what);
    if (rule.what == "colour format") facts.colour = link_colour_from(property->value_text());
    const std::optional<std::uint64_t> wanted = wanted_value(rule, *property);
    if (!wanted || property->value == *wanted) continue;
    facts.scaled = facts.scaled || rule.what == "scaling" || rule.what == "underscan";
    facts.differ.push_back(fmt::format("{}: the graphics card has set its {} (\"{}\") to {} instead of {}", output.connector.name,
                                       rule.what, rule.property, property->value_text(), text_of_value(*property, *wanted)));
  }
  for (const Rule& rule : kRules)
    if (rule.told && std::find(told.begin(), told.end(), rule.what) == told.end()) add_once(facts.not_told, rule.what);
  facts.turned = is_turned(card, output);
  return facts;
}

Monitor monitor_of(const Output& output, const LinkFacts& facts) {
  Monitor monitor;
  monitor.connector = output.connector.name;
  monitor.edid = output.edid;
  monitor.shown = monitor.mode = output.mode.size;
  monitor.native = output.native;
  if (monitor.native.width == 0)
    for (const Mode& mode : output.connector.modes)
      if (mode.preferred) monitor.native = mode.size;
  monitor.refresh_hz = output.mode.refresh_hz;
  monitor.transformed = facts.scaled;
  monitor.turned = facts.turned;
  monitor.colour = facts.colour;
  return monitor;
}

}  // namespace prismesh::kiosk::display::kms
