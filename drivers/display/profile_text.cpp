// Reads and writes profiles as TOML, from one table of keys for both directions.
#include <algorithm>
#include <charconv>
#include <functional>
#include <vector>

#include <toml++/toml.h>

#include "base/nearest_name.h"
#include "base/toml_text.h"
#include "drivers/display/profile.h"

namespace prismesh::drivers::display {

namespace {

template <class Value>
using Names = std::vector<std::pair<std::string_view, Value>>;

const Names<Weave>& weave_names() {
  static const Names<Weave> kNames{{"mask", Weave::mask},         {"columns", Weave::columns},           {"stencil", Weave::stencil},
                                   {"rows", Weave::rows},         {"side-by-side", Weave::side_by_side}, {"top-bottom", Weave::top_bottom},
                                   {"anaglyph", Weave::anaglyph}, {"one-eye", Weave::one_eye},           {"centre", Weave::centre}};
  return kNames;
}
const Names<Eye>& eye_names() {
  static const Names<Eye> kNames{{"left", Eye::left}, {"right", Eye::right}};
  return kNames;
}
const Names<Subpixels>& subpixel_names() {
  static const Names<Subpixels> kNames{{"none", Subpixels::none}, {"rgb", Subpixels::rgb}, {"bgr", Subpixels::bgr}};
  return kNames;
}

std::string number_text(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

/// One key of the file. `read` returns a description of the required value, or nothing if the value is valid. `write` returns the value's
/// text; empty: the key is left out.
struct Key {
  std::string_view section;  ///< empty: before the first section
  std::string_view name;
  std::string_view comment;
  std::function<std::string(const toml::node&, Profile&)> read;
  std::function<std::string(const Profile&)> write;
};

struct Range {
  double min, max;
};

template <class Field>
Key number(std::string_view section, std::string_view name, Range range, std::string_view comment, Field field) {
  return {section, name, comment,
          [=](const toml::node& node, Profile& profile) -> std::string {
            const auto value = node.is_number() ? node.value<double>() : std::nullopt;
            if (!value || !(*value >= range.min && *value <= range.max))
              return "a number from " + number_text(range.min) + " to " + number_text(range.max);
            field(profile) = *value;
            return {};
          },
          [=](const Profile& profile) { return number_text(field(profile)); }};
}

template <class Field>
Key flag(std::string_view section, std::string_view name, std::string_view comment, Field field) {
  return {section, name, comment,
          [=](const toml::node& node, Profile& profile) -> std::string {
            if (!node.is_boolean()) return "true or false";
            field(profile) = *node.value<bool>();
            return {};
          },
          [=](const Profile& profile) { return field(profile) ? "true" : "false"; }};
}

template <class Field>
Key text(std::string_view section, std::string_view name, std::string_view comment, Field field) {
  return {section, name, comment,
          [=](const toml::node& node, Profile& profile) -> std::string {
            if (!node.is_string()) return "a text in quotes";
            field(profile) = *node.value<std::string>();
            return {};
          },
          [=](const Profile& profile) { return toml_quoted(field(profile)); }};
}

template <class Value, class Field>
Key choice(std::string_view name, std::string_view comment, const Names<Value>& names, Field field) {
  return {"", name, comment,
          [=, &names](const toml::node& node, Profile& profile) -> std::string {
            const auto given = node.value<std::string>();
            std::string known;
            for (const auto& [known_name, value] : names) {
              if (given == known_name) return field(profile) = value, std::string();
              known += (known.empty() ? "" : ", ") + toml_quoted(known_name);
            }
            return "one of " + known;
          },
          [=, &names](const Profile& profile) {
            for (const auto& [known_name, value] : names)
              if (field(profile) == value) return toml_quoted(known_name);
            return std::string();
          }};
}

Key eye_separation() {
  return {"", "eye_separation_mm", "of the viewer it was calibrated with",
          [](const toml::node& node, Profile& profile) -> std::string {
            const auto value = node.is_number() ? node.value<double>() : std::nullopt;
            if (!value || !(*value >= 50 && *value <= 75)) return "a number from 50 to 75";
            profile.eye_separation_mm = value;
            return {};
          },
          [](const Profile& profile) { return profile.eye_separation_mm ? number_text(*profile.eye_separation_mm) : std::string(); }};
}

Key panel_pixels() {
  return {"monitor", "pixels", "columns and rows of the panel; 0: any",
          [](const toml::node& node, Profile& profile) -> std::string {
            const toml::array* sides = node.as_array();
            if (sides == nullptr || sides->size() != 2) return "columns and rows, for example [1920, 1080]";
            for (std::size_t i = 0; i < 2; ++i) {
              const auto side = sides->get(i)->is_integer() ? sides->get(i)->value<std::int64_t>() : std::nullopt;
              if (!side || *side < 0 || *side > 16384) return "two whole numbers from 0 to 16384";
              profile.monitor.pixels[i] = static_cast<int>(*side);
            }
            return {};
          },
          [](const Profile& profile) {
            return "[" + std::to_string(profile.monitor.pixels[0]) + ", " + std::to_string(profile.monitor.pixels[1]) + "]";
          }};
}

const std::vector<Key>& keys() {
  static const std::vector<Key> kKeys{
      text(
          "", "name", "", [](auto& p) -> auto& { return p.name; }),
      choice(
          "weave", "how the eyes' pictures become one", weave_names(), [](auto& p) -> auto& { return p.weave; }),
      choice(
          "eye", "whose picture one-eye shows; else the eye that the pointer aims with", eye_names(),
          [](auto& p) -> auto& { return p.eye; }),
      flag(
          "", "swap_eyes", "exchanges the eyes' places on the panel", [](auto& p) -> auto& { return p.swap_eyes; }),
      choice(
          "subpixels", "order of a pixel's colours, where the mask tells them apart", subpixel_names(),
          [](auto& p) -> auto& { return p.subpixels; }),
      number(
          "", "pixel_pitch_mm", {0.01, 10}, "", [](auto& p) -> auto& { return p.optics.pixel_pitch_mm; }),
      number(
          "", "gamma", {1, 4}, "light = value ^ gamma", [](auto& p) -> auto& { return p.gamma; }),
      eye_separation(),
      flag(
          "mask", "moves", "a servo shifts it", [](auto& p) -> auto& { return p.mask_moves; }),
      number(
          "mask", "design_distance_mm", {100, 20000}, "", [](auto& p) -> auto& { return p.optics.design_distance_mm; }),
      number(
          "mask", "design_separation_mm", {40, 90}, "of the eyes", [](auto& p) -> auto& { return p.optics.design_separation_mm; }),
      number(
          "mask", "refractive_index", {1, 3}, "of what lies between panel and mask",
          [](auto& p) -> auto& { return p.optics.refractive_index; }),
      number(
          "mask", "lean", {-2, 2}, "dx/dy of the elements", [](auto& p) -> auto& { return p.optics.lean; }),
      number(
          "mask", "zero_mm", {-100, 100}, "where it stands when the servo says 0", [](auto& p) -> auto& { return p.optics.zero_mm; }),
      number(
          "mask", "pitch_scale", {0.2, 10}, "real pitch over the computed one", [](auto& p) -> auto& { return p.optics.pitch_scale; }),
      number(
          "mask", "gap_scale", {0.1, 10}, "real gap over the computed one", [](auto& p) -> auto& { return p.optics.gap_scale; }),
      number(
          "crosstalk", "left", {0, 0.5}, "share of the right eye's light that the left one sees",
          [](auto& p) -> auto& { return p.crosstalk[0]; }),
      number(
          "crosstalk", "right", {0, 0.5}, "and the other way round", [](auto& p) -> auto& { return p.crosstalk[1]; }),
      text(
          "monitor", "name", "as the monitor says it; empty: any", [](auto& p) -> auto& { return p.monitor.name; }),
      text(
          "monitor", "serial", "", [](auto& p) -> auto& { return p.monitor.serial; }),
      panel_pixels(),
  };
  return kKeys;
}

tl::unexpected<Error> wrong(const std::string& file, const toml::source_region& at, const std::string& message) {
  return fail(file, static_cast<long>(at.begin.line), message);
}

std::string in_section(std::string_view section) { return section.empty() ? "" : " in [" + std::string(section) + "]"; }

tl::unexpected<Error> unknown_key(const std::string& file, const toml::source_region& at, std::string_view section, std::string_view name) {
  std::vector<std::string_view> known;
  if (section.empty()) known = {"mask", "crosstalk", "monitor"};
  for (const Key& key : keys()) {
    if (key.section == section) known.push_back(key.name);
    if (key.name == name && key.section != section)
      return wrong(file, at,
                   "\"" + std::string(name) + "\" belongs " +
                       (key.section.empty() ? "before the first section" : "into [" + std::string(key.section) + "]"));
  }
  return wrong(file, at,
               "unknown key \"" + std::string(name) + "\"" + in_section(section) + "; the nearest known one is \"" +
                   std::string(nearest_name(name, known)) + "\"");
}

Result<void> read_table(const std::string& file, std::string_view section, const toml::table& table, Profile& profile) {
  for (const auto& [name, node] : table) {
    const bool names_section = section.empty() && (name == "mask" || name == "crosstalk" || name == "monitor");
    if (names_section) {
      if (!node.is_table())
        return wrong(file, node.source(), std::string(name.str()) + " must be a section: [" + std::string(name.str()) + "]");
      if (const auto read = read_table(file, name.str(), *node.as_table(), profile); !read) return fail(read.error());
      continue;
    }
    const std::string_view wanted_name = name.str();
    const auto key =
        std::find_if(keys().begin(), keys().end(), [&](const Key& k) { return k.section == section && k.name == wanted_name; });
    if (key == keys().end()) return unknown_key(file, name.source(), section, name.str());
    if (const std::string wanted = key->read(node, profile); !wanted.empty())
      return wrong(file, node.source(), std::string(key->name) + in_section(section) + " must be " + wanted);
  }
  return {};
}

}  // namespace

Result<Profile> parse_profile(std::string_view toml_text, const std::string& file) {
  Profile profile;
  profile.name = std::filesystem::path(file).stem().string();
  try {
    const toml::table table = toml::parse(toml_text, file);
    if (const auto read = read_table(file, "", table, profile); !read) return fail(read.error());
  } catch (const toml::parse_error& error) {
    return fail(file, static_cast<long>(error.source().begin.line), std::string(error.description()));
  }
  return profile;
}

std::string profile_text(const Profile& profile) {
  std::string written = "# A display profile of Prismesh.\n";
  std::string_view section;
  for (const Key& key : keys()) {
    const std::string value = key.write(profile);
    if (value.empty()) continue;
    if (key.section != section) written += "\n[" + std::string(section = key.section) + "]\n";
    written += std::string(key.name) + " = " + value;
    written += key.comment.empty() ? "\n" : "  # " + std::string(key.comment) + "\n";
  }
  return written;
}

}  // namespace prismesh::drivers::display
