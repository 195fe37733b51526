#include "kiosk/render_command.h"

#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "ipc/model/field_page.h"
#include "ipc/model/snapshot.h"
#include "kiosk/display/headless.h"
#include "kiosk/panels/gui.h"
#include "kiosk/render/offscreen.h"
#include "kiosk/render/renderer.h"
#include "kiosk/toolkit/words_on_thickness.h"
#include "kiosk/tools/comparison/legend.h"

namespace prismesh::kiosk {

namespace {

constexpr int kDone = 0, kFailed = 1, kWrongUsage = 2;
constexpr int kMaxSide = 16384;

struct RenderOptions {
  std::filesystem::path picture;
  std::vector<int> descriptors;  ///< the snapshot's table, then its segments
  int width = 1920;
  int height = 1080;
  std::string profile = "prism-mask";
  mesh::Vec3 eye_mm = mesh::Vec3(0, 0, 650);
  std::optional<double> mask_mm;  ///< empty: where it should be
  std::string view = "iso";
  std::string colour = "parts";
  std::optional<int> field;  ///< descriptor of a field's values
  tools::comparison::LegendFacts legend;
  int samples = 4;
  bool thickness = false;
  bool has_legend = true;          ///< of a field
  bool legend_below = false;       ///< the model is drawn above the legend, not behind it
  std::optional<stereo::Box> box;  ///< fills the picture; empty: the whole model
};

/// Numbers separated by `separator`, nothing else; empty if the text is anything else.
template <class T>
std::vector<T> numbers(const std::string& text, char separator) {
  std::vector<T> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    T value{};
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return {};
    values.push_back(value);
    if (next == end) return values;
    if (*next != separator) return {};
    at = next + 1;
  }
}

template <class Names>
std::string list_of(const Names& names) {
  std::string list;
  for (const auto& name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

tl::unexpected<Error> wrong(const std::string& option, const std::string& value, const std::string& wanted) {
  return fail(option + " " + value, wanted);
}

Result<void> read_size(const std::string& text, RenderOptions& options) {
  const std::vector<int> sides = numbers<int>(text, 'x');
  if (sides.size() != 2 || sides[0] < 16 || sides[1] < 16 || sides[0] > kMaxSide || sides[1] > kMaxSide)
    return wrong("--size", text, "write width and height in pixels, for example 1920x1080 (16 to " + std::to_string(kMaxSide) + " each)");
  options.width = sides[0];
  options.height = sides[1];
  return {};
}

Result<void> read_eye(const std::string& text, RenderOptions& options) {
  const std::vector<double> point = numbers<double>(text, ',');
  const bool whole = point.size() == 3 && std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2]);
  if (!whole || point[2] < 100 || std::abs(point[0]) > 1e4 || std::abs(point[1]) > 1e4 || point[2] > 1e4)
    return wrong("--eye", text,
                 "write the point between the eyes as X,Y,Z in mm from the screen's centre, for example 0,0,650; Z from 100 to 10000");
  options.eye_mm = mesh::Vec3(point[0], point[1], point[2]);
  return {};
}

Result<void> read_mask(const std::string& text, RenderOptions& options) {
  const std::vector<double> place = numbers<double>(text, ',');
  if (place.size() != 1 || !(std::abs(place[0]) <= 100))
    return wrong("--mask", text, "write where the mask stands in mm from its zero, for example 0.12; -100 to 100");
  options.mask_mm = place[0];
  return {};
}

Result<void> read_descriptors(const std::string& text, RenderOptions& options) {
  options.descriptors = numbers<int>(text, ',');
  if (options.descriptors.empty()) return wrong("--snapshot-fds", text, "write the descriptors of a snapshot's table and segments: 3,4,5");
  return {};
}

Result<void> read_samples(const std::string& text, RenderOptions& options) {
  if (text != "1" && text != "4") return wrong("--samples", text, "samples per pixel are 1 or 4");
  options.samples = text == "4" ? 4 : 1;
  return {};
}

Result<void> read_thickness(const std::string& text, RenderOptions& options) {
  if (text != "on" && text != "off") return wrong("--thickness", text, "is on or off");
  options.thickness = text == "on";
  return {};
}

Result<void> read_legend(const std::string& text, RenderOptions& options) {
  if (text != "over" && text != "below" && text != "none") return wrong("--legend", text, "is over (the model), below (it) or none");
  options.has_legend = text != "none";
  options.legend_below = text == "below";
  return {};
}

Result<void> read_box(const std::string& text, RenderOptions& options) {
  const std::vector<double> sides = numbers<double>(text, ',');
  stereo::Box box;
  if (sides.size() == 6) {
    box.add({sides[0], sides[1], sides[2]});
    box.add({sides[3], sides[4], sides[5]});
  }
  if (box.empty() || !box.low.allFinite() || !box.high.allFinite() || box.low == box.high)
    return wrong("--box", text, "write two different corners as X,Y,Z,X,Y,Z, in the deck's length unit");
  options.box = box;
  return {};
}

Result<void> read_view(const std::string& text, RenderOptions& options) {
  options.view = text;
  if (stereo::named_rotation(text)) return {};
  return wrong("--view", text, "there is no view of this name; views are " + list_of(stereo::kViewNames));
}

Result<void> read_colour(const std::string& text, RenderOptions& options) {
  options.colour = text;
  if (render::colour_mode_from(text)) return {};
  return wrong("--colour", text,
               "there is no colour mode of this name; modes are " + list_of(render::kColourModeNames) +
                   ", displacement, distance-to-original, distance, metric:NAME, composite, time-step");
}

Result<void> read_limits(const std::string& text, RenderOptions& options) {
  const std::vector<double> limits = numbers<double>(text, ',');
  if (limits.size() != 2 || !std::isfinite(limits[0]) || !std::isfinite(limits[1]) || limits[0] == limits[1])
    return wrong("--limits", text,
                 "write where the colour map begins and where it ends as CLEAR,FULL, two different numbers, for example 1,5");
  options.legend.look.clear = limits[0];
  options.legend.look.full = limits[1];
  return {};
}

Result<void> read_map(const std::string& text, RenderOptions& options) {
  const auto map = render::colour_map_from(text);
  if (!map) return wrong("--map", text, "there is no colour map of this name; maps are " + list_of(render::kColourMapNames));
  options.legend.look.map = *map;
  return {};
}

Result<void> read_bands(const std::string& text, RenderOptions& options) {
  const std::vector<int> bands = numbers<int>(text, ',');
  if (bands.size() != 1 || bands[0] < 2 || bands[0] > 64) return wrong("--bands", text, "write how many colours, 2 to 64");
  options.legend.look.bands = bands[0];
  return {};
}

Result<void> read_field(const std::string& option, const std::string& text, RenderOptions& options) {
  const std::vector<double> values = numbers<double>(text, ',');
  if (option == "--field-fd" && values.size() == 1) {
    options.field = static_cast<int>(values[0]);
    options.legend.look.on = true;
  } else if (option == "--field-range" && values.size() == 2) {
    options.legend.min = values[0];
    options.legend.max = values[1];
  } else if (option == "--field-without" && values.size() == 1 && values[0] >= 0) {
    options.legend.shells_without = static_cast<std::size_t>(values[0]);
  } else {
    return wrong(option, text, "isn't what `prismesh render` gives");
  }
  return {};
}

Result<RenderOptions> parse(std::span<const std::string> arguments) {
  RenderOptions options;
  using Reader = std::function<Result<void>(const std::string&)>;
  const std::map<std::string, Reader> readers{
      {"--render", [&](const std::string& text) { return options.picture = text, Result<void>(); }},
      {"--profile", [&](const std::string& text) { return options.profile = text, Result<void>(); }},
      {"--snapshot-fds", [&](const std::string& text) { return read_descriptors(text, options); }},
      {"--size", [&](const std::string& text) { return read_size(text, options); }},
      {"--eye", [&](const std::string& text) { return read_eye(text, options); }},
      {"--mask", [&](const std::string& text) { return read_mask(text, options); }},
      {"--view", [&](const std::string& text) { return read_view(text, options); }},
      {"--legend", [&](const std::string& text) { return read_legend(text, options); }},
      {"--box", [&](const std::string& text) { return read_box(text, options); }},
      {"--thickness", [&](const std::string& text) { return read_thickness(text, options); }},
      {"--colour", [&](const std::string& text) { return read_colour(text, options); }},
      {"--limits", [&](const std::string& text) { return read_limits(text, options); }},
      {"--map", [&](const std::string& text) { return read_map(text, options); }},
      {"--bands", [&](const std::string& text) { return read_bands(text, options); }},
      {"--field-fd", [&](const std::string& text) { return read_field("--field-fd", text, options); }},
      {"--field-without", [&](const std::string& text) { return read_field("--field-without", text, options); }},
      {"--field-range", [&](const std::string& text) { return read_field("--field-range", text, options); }},
      {"--field-title", [&](const std::string& text) { return options.legend.title = text, Result<void>(); }},
      {"--field-unit", [&](const std::string& text) { return options.legend.unit = text, Result<void>(); }},
      {"--field-of", [&](const std::string& text) { return options.legend.of = text, Result<void>(); }},
      {"--field-least", [&](const std::string& text) { return options.legend.min_at = text, Result<void>(); }},
      {"--field-most", [&](const std::string& text) { return options.legend.max_at = text, Result<void>(); }},
      {"--samples", [&](const std::string& text) { return read_samples(text, options); }}};
  for (std::size_t i = 0; i < arguments.size(); i += 2) {
    const auto reader = readers.find(arguments[i]);
    if (reader == readers.end()) return fail("prismesh-kiosk --render", "there is no option " + arguments[i]);
    if (i + 1 == arguments.size()) return fail("prismesh-kiosk --render", arguments[i] + " needs a value");
    if (const auto read = reader->second(arguments[i + 1]); !read) return fail(read.error());
  }
  if (options.picture.empty()) return fail("prismesh-kiosk --render", "--render needs the name of the picture");
  if (options.descriptors.empty()) return fail("prismesh-kiosk --render", "--snapshot-fds is missing; `prismesh render` gives it");
  return options;
}

Result<std::shared_ptr<const ipc::SnapshotView>> map_snapshot(const std::vector<int>& descriptors) {
  const ipc::Descriptor table(descriptors.front());
  std::vector<std::shared_ptr<const ipc::Mapping>> segments;
  for (std::size_t i = 1; i < descriptors.size(); ++i) {
    const ipc::Descriptor segment(descriptors[i]);
    Result<ipc::Mapping> mapping = ipc::Mapping::map(segment, false);
    if (!mapping) return fail(mapping.error());
    segments.push_back(std::make_shared<const ipc::Mapping>(std::move(*mapping)));
  }
  return ipc::SnapshotView::map(table, segments);
}

/// The view of the whole model, or of the box. With the legend below, the model keeps to what is left above it.
stereo::View view_of(const RenderOptions& options, const render::Renderer& renderer, const render::Picture& picture) {
  constexpr double kLegendPixels = 190;
  stereo::View view = picture.view;
  Eigen::Vector2d screen = stereo::screen_size_mm(picture.profile, options.width, options.height);
  if (options.field && options.legend_below && options.height > 2 * kLegendPixels) {
    const double room = screen.y() * kLegendPixels / options.height;
    screen.y() -= room;
    view.middle_mm = {0, room / 2};
  }
  return options.box ? stereo::fit(view, *options.box, screen, options.eye_mm.z()) : renderer.fitted(view, screen, options.eye_mm.z());
}

/// Gives the renderer the field, and lays its legend out.
Result<panels::Gui> show_field(const RenderOptions& options, render::Renderer& renderer, render::Picture& picture) {
  const ipc::Descriptor descriptor(*options.field);
  const auto values = ipc::FieldValues::map(descriptor);
  if (!values) return fail(values.error());
  if (const auto set = renderer.set_field(render::Pane::model, (*values)->values(), (*values)->on_nodes()); !set) return fail(set.error());
  picture.colour = render::ColourMode::field;
  picture.field[0] = options.legend.look;
  picture.quality_glyphs = false;  // yellow and red would be read as values
  Result<panels::Gui> gui = panels::Gui::create();
  if (!gui) return gui;
  if (const auto type = gui->set_type(picture.profile.stereo() ? panels::kStereoType : panels::kFlatType); !type) return fail(type.error());
  // Panels that fit their content have their size after the second time.
  for (int round = 0; round < 3; ++round)
    gui->layout({options.width, options.height}, 0.02, [&] {
      panels::PanelLayout layout{{options.width, options.height}};
      tools::comparison::legend(options.legend, layout);
    });
  return gui;
}

Result<void> render_picture(const RenderOptions& options, const stereo::Profile& profile) {
  const auto snapshot = map_snapshot(options.descriptors);
  if (!snapshot) return fail(snapshot.error());
  const Result<display::Headless> headless = display::Headless::create();
  if (!headless) return fail(headless.error());
  const Result<render::Offscreen> offscreen = render::Offscreen::create(options.width, options.height);
  if (!offscreen) return fail(offscreen.error());
  const auto renderer = render::Renderer::create({.samples = options.samples});
  if (!renderer) return fail(renderer.error());
  if (const auto shown = (*renderer)->set_model(render::snapshot_source(*snapshot)); !shown) return fail(shown.error());

  render::Picture picture;
  picture.profile = profile;
  picture.between_eyes_mm = options.eye_mm;
  picture.eye_separation_mm = profile.eye_separation_mm.value_or(stereo::kMeanEyeSeparationMm);
  picture.mask_mm = options.mask_mm;
  picture.colour = *render::colour_mode_from(options.colour);
  picture.thickness = options.thickness;
  picture.view.rotation = *stereo::named_rotation(options.view);
  picture.view.bounds = stereo::sphere_around((*renderer)->bounds());
  picture.view = view_of(options, **renderer, picture);
  std::optional<panels::Gui> gui;
  if (options.field) {
    Result<panels::Gui> shown = show_field(options, **renderer, picture);
    if (!shown) return fail(shown.error());
    gui = std::move(*shown);
    if (options.has_legend)
      picture.overlay = [&](const render::EyeImage& image) { gui->draw({image.width, image.height}, image.from_picture); };
  }
  if (const std::string note = options.thickness ? toolkit::words_on_thickness((*snapshot)->info().parts) : std::string(); !note.empty())
    std::fprintf(stderr, "%s: note: %s\n", options.picture.c_str(), note.c_str());
  const auto report = (*renderer)->draw(picture, offscreen->framebuffer(), options.width, options.height);
  if (!report) return fail(report.error());
  if (report->glyphs_left_out > 0)
    std::fprintf(stderr, "%s: note: %zu quality glyphs found no room and aren't drawn; %zu are\n", options.picture.c_str(),
                 report->glyphs_left_out, report->glyphs);
  return render::write_png(options.picture, offscreen->read());
}

int complain(const Error& error, int status) {
  std::fprintf(stderr, "%s\n", error.text().c_str());
  return status;
}

}  // namespace

int render_main(std::span<const std::string> arguments) {
  const Result<RenderOptions> options = parse(arguments);
  if (!options) return complain(options.error(), kWrongUsage);
  std::error_code ignored;
  const bool is_file = std::filesystem::exists(options->profile, ignored);
  const Result<stereo::Profile> profile = stereo::find_profile(options->profile);
  if (!profile) return complain(profile.error(), is_file ? kFailed : kWrongUsage);
  const Result<void> done = render_picture(*options, *profile);
  return done ? kDone : complain(done.error(), kFailed);
}

}  // namespace prismesh::kiosk
