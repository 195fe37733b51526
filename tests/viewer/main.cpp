// prismesh-viewer: computes what each eye sees, from a woven picture, a display and the eyes' true positions.
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "tests/viewer/light.h"
#include "tests/viewer/mask_display.h"
#include "tests/viewer/other_displays.h"
#include "tests/viewer/owners.h"
#include "tests/viewer/seen.h"

namespace prismesh::viewer {
namespace {

constexpr int kDone = 0, kFailed = 1, kWrongUsage = 2;

struct Options {
  std::string woven, left, right, expected_left, expected_right, left_lit, right_lit;
  std::string kind = "mask", stripes = "rgb", eye = "0,0,650", toward_right = "1,0,0";
  MaskDisplay display;
  Sharpness sharpness;
  double separation_mm = 63;
  double gamma = 0;
  std::optional<double> mask_mm;
  bool swapped = false;
  bool json = false;

  Eyes eyes;  ///< from the texts above
};

bool read_point(const std::string& text, Point& point) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (double* const number : {&point.x, &point.y, &point.z}) {
    const auto [next, error] = std::from_chars(at, end, *number);
    if (error != std::errc() || !std::isfinite(*number)) return false;
    if (number == &point.z) return next == end;
    if (next == end || *next != ',') return false;
    at = next + 1;
  }
  return false;
}

void add_options(CLI::App& app, Options& options) {
  app.add_option("woven", options.woven, "PNG: the picture as the panel shows it")->required()->option_text("WOVEN");
  app.add_option("--left", options.left, "Write what the left eye sees")->option_text("PNG");
  app.add_option("--right", options.right, "Write what the right eye sees")->option_text("PNG");
  app.add_option("--display", options.kind, "mask (prisms, lenses, slits), rows, side-by-side, top-bottom, anaglyph, ordinary (mask)")
      ->option_text("KIND");
  app.add_flag("--swapped", options.swapped, "Not for mask: the other eye has the first row, half or glass");
  app.add_option("--eye", options.eye, "The point between the eyes, mm from the screen's middle (0,0,650)")->option_text("X,Y,Z");
  app.add_option("--separation", options.separation_mm, "Of the eyes, mm (63)")->check(CLI::Range(20.0, 120.0))->option_text("MM");
  app.add_option("--toward-right", options.toward_right, "Direction from the left eye to the right one (1,0,0)")->option_text("X,Y,Z");
  app.add_option("--mask", options.mask_mm, "Where the mask stands, mm (where it suits the eyes)")->option_text("MM");
  app.add_option("--pitch", options.display.panel.pitch_mm, "Of the panel's pixels, mm (0.2805)")->option_text("MM");
  app.add_option("--stripes", options.stripes, "Of a pixel: rgb, bgr, none (rgb)")->option_text("ORDER");
  app.add_option("--gamma", options.gamma, "Of the panel: light = value ^ gamma; 0 is sRGB (0)")
      ->check(CLI::Range(0.0, 5.0))
      ->option_text("GAMMA");
  app.add_option("--design-distance", options.display.design_distance_mm, "mm (650)")->option_text("MM");
  app.add_option("--design-separation", options.display.design_separation_mm, "Of the eyes the mask was made for, mm (63)")
      ->option_text("MM");
  app.add_option("--index", options.display.index, "Of refraction, between panel and mask (1.52)")->option_text("N");
  app.add_option("--lean", options.display.lean, "Of the mask's elements, dx/dy (0)")->option_text("RATIO");
  app.add_option("--mask-offset", options.display.offset_mm, "How far the mask stands from where its servo says, mm (0)")
      ->option_text("MM");
  app.add_option("--window", options.sharpness.window_pixels, "Pixels seen through an element (1)")->option_text("PIXELS");
  app.add_option("--leak", options.sharpness.leak, "Light of the other eye's that comes through, 0 to 1 (0)")->option_text("SHARE");
  app.add_option("--expected-left", options.expected_left, "The left eye's picture on an ordinary screen, to compare with")
      ->option_text("PNG");
  app.add_option("--expected-right", options.expected_right, "The right eye's")->option_text("PNG");
  auto* left_lit =
      app.add_option("--left-lit", options.left_lit, "Woven from white for the left and black for the right eye: tells whose a pixel is");
  auto* right_lit = app.add_option("--right-lit", options.right_lit, "The other way round");
  left_lit->option_text("PNG")->needs(right_lit);
  right_lit->option_text("PNG")->needs(left_lit);
  app.add_flag("--json", options.json, "Print one JSON object");
  app.set_version_flag("--version", PRISMESH_VERSION);
  app.footer(
      "Prints what was found: phase errors in pixels (with --left-lit and --right-lit), and how far what is seen is from what was\n"
      "expected, in levels of 255 (with --expected-left and --expected-right). docs/display/optics.md explains the model.");
}

/// Errors: invalid values, with the expected form.
Result<void> understand(Options& options) {
  Point between, toward_right;
  if (!read_point(options.eye, between) || between.z < 50)
    return fail("--eye " + options.eye, "write three numbers in mm, the last at least 50, for example 0,0,650");
  if (!read_point(options.toward_right, toward_right) || std::hypot(toward_right.x, toward_right.y, toward_right.z) < 1e-6)
    return fail("--toward-right " + options.toward_right, "write a direction as three numbers, for example 1,0,0");
  options.eyes = eyes_around(between, options.separation_mm, toward_right);
  if (options.kind != "mask" && !plain_kind_from(options.kind))
    return fail("--display " + options.kind,
                "there is no display of this kind; kinds are mask, rows, side-by-side, top-bottom, anaglyph, ordinary");
  if (options.stripes == "bgr")
    options.display.panel.stripes = Stripes::bgr;
  else if (options.stripes == "none")
    options.display.panel.stripes = Stripes::none;
  else if (options.stripes != "rgb")
    return fail("--stripes " + options.stripes, "stripes are rgb, bgr or none");
  if (!options.mask_mm) {
    MaskDisplay believed = options.display;
    believed.offset_mm = 0;  // the software doesn't know it
    options.mask_mm = believed.ideal_mask_mm(between);
  }
  return {};
}

/// The results for one eye.
struct Verdict {
  std::optional<double> difference;        ///< levels, from what it should see
  std::optional<double> other_difference;  ///< levels, from what the other eye should see
  std::optional<double> other_share;
};

Result<Verdict> judge_mask(const Options& options, const LightImage& woven, bool left, const LightImage& own, const LightImage& other) {
  const Result<Seen> seen =
      look(options.display, woven, left ? options.eyes.left : options.eyes.right, *options.mask_mm, options.sharpness);
  if (!seen) return fail(seen.error());
  if (const std::string& path = left ? options.left : options.right; !path.empty())
    if (const Result<void> written = write_picture(path, on_grid(options.display, *seen, woven.width)); !written)
      return fail(written.error());
  if (own.width == 0) return Verdict{};
  const Seen expected = ordinary(options.display, own, *seen), wrong = ordinary(options.display, other, *seen);
  return Verdict{mean_difference(*seen, expected), mean_difference(*seen, wrong), share_of_other(*seen, expected, wrong)};
}

Result<Verdict> judge_plain(const Options& options, const LightImage& woven, bool left, const LightImage& own, const LightImage& other) {
  const PlainKind kind = *plain_kind_from(options.kind);
  const LightImage seen = seen_on(kind, woven, left, options.swapped, options.sharpness.leak);
  if (const std::string& path = left ? options.left : options.right; !path.empty())
    if (const Result<void> written = write_picture(path, resized(seen, woven.width, woven.height)); !written) return fail(written.error());
  if (own.width == 0) return Verdict{};
  return Verdict{
      mean_difference(seen, resized(own, seen.width, seen.height)), mean_difference(seen, resized(other, seen.width, seen.height)), {}};
}

Result<LightImage> picture_like(const std::string& path, const LightImage& woven, double gamma = 0) {
  Result<LightImage> picture = read_picture(path, gamma);
  if (picture && (picture->width != woven.width || picture->height != woven.height))
    return fail(path, "is " + std::to_string(picture->width) + "x" + std::to_string(picture->height) + ", but the woven picture is " +
                          std::to_string(woven.width) + "x" + std::to_string(woven.height));
  return picture;
}

void print_verdict(const char* eye, const Verdict& verdict) {
  if (!verdict.difference) return;
  std::printf("%s eye: %.2f levels from its own picture, %.2f from the other eye's", eye, *verdict.difference, *verdict.other_difference);
  if (verdict.other_share) std::printf("; %.1f %% of the other's detail is mixed in", 100 * *verdict.other_share);
  std::printf("\n");
}

void print_json_verdict(const char* eye, const Verdict& verdict) {
  if (!verdict.difference) return;
  std::printf(", \"%s\": {\"difference\": %.4f, \"other_difference\": %.4f", eye, *verdict.difference, *verdict.other_difference);
  if (verdict.other_share) std::printf(", \"other_share\": %.5f", *verdict.other_share);
  std::printf("}");
}

void print(const Options& options, const std::optional<PhaseSummary>& phase, const Verdict& left, const Verdict& right) {
  const bool mask = options.kind == "mask";
  if (options.json) {
    std::printf("{\"display\": \"%s\"", options.kind.c_str());
    if (mask) std::printf(", \"mask_mm\": %.6f", *options.mask_mm);
    if (phase)
      std::printf(", \"phase\": {\"windows\": %zu, \"worst\": %.5f, \"p99\": %.5f, \"mean\": %.5f, \"wrong_share\": %.5f}", phase->windows,
                  std::min(phase->worst_pixels, 1e9), std::min(phase->p99_pixels, 1e9), std::min(phase->mean_pixels, 1e9),
                  phase->mean_wrong_share);
    print_json_verdict("left", left);
    print_json_verdict("right", right);
    std::printf("}\n");
    return;
  }
  if (mask)
    std::printf("mask at %+.4f mm; elements %.5f mm apart on %.3f mm of glass\n", *options.mask_mm, options.display.element_pitch_mm(),
                options.display.glass_mm());
  if (phase)
    std::printf("phase error over %zu windows: %.3f px at worst, %.3f px p99, %.3f px mean; %.1f %% of what is seen is the other eye's\n",
                phase->windows, phase->worst_pixels, phase->p99_pixels, phase->mean_pixels, 100 * phase->mean_wrong_share);
  print_verdict("left", left);
  print_verdict("right", right);
}

Result<std::optional<PhaseSummary>> phase_of(const Options& options, const LightImage& woven) {
  if (options.left_lit.empty()) return std::optional<PhaseSummary>();
  if (options.kind != "mask") return fail("--left-lit", "phase errors are those of a mask; leave this out for --display " + options.kind);
  const Result<LightImage> left = picture_like(options.left_lit, woven), right = picture_like(options.right_lit, woven);
  if (!left) return fail(left.error());
  if (!right) return fail(right.error());
  const Result<Owners> owners = owners_of(options.display.panel, *left, *right);
  if (!owners) return fail(owners.error());
  const int rows = options.display.panel.rows;
  return phase_summary(options.display, *owners, options.eyes, *options.mask_mm, {0, rows / 4, rows / 2, 3 * rows / 4, rows - 1});
}

Result<void> run(Options& options) {
  const Result<LightImage> woven = read_picture(options.woven, options.gamma);
  if (!woven) return fail(woven.error());
  options.display.panel.columns = woven->width;
  options.display.panel.rows = woven->height;
  if (const Result<void> checked = options.display.check(); !checked) return checked;
  LightImage left, right;
  if (options.expected_left.empty() != options.expected_right.empty())
    return fail("prismesh-viewer", "give both --expected-left and --expected-right, or neither");
  if (!options.expected_left.empty()) {
    Result<LightImage> expected_left = picture_like(options.expected_left, *woven, options.gamma),
                       expected_right = picture_like(options.expected_right, *woven, options.gamma);
    if (!expected_left) return fail(expected_left.error());
    if (!expected_right) return fail(expected_right.error());
    left = std::move(*expected_left), right = std::move(*expected_right);
  }
  const auto phase = phase_of(options, *woven);
  if (!phase) return fail(phase.error());
  const auto judge = options.kind == "mask" ? judge_mask : judge_plain;
  const Result<Verdict> of_left = judge(options, *woven, true, left, right);
  if (!of_left) return fail(of_left.error());
  const Result<Verdict> of_right = judge(options, *woven, false, right, left);
  if (!of_right) return fail(of_right.error());
  print(options, *phase, *of_left, *of_right);
  return {};
}

int main_of(int argc, char** argv) {
  Options options;
  CLI::App app("What each eye sees of a woven picture: traces rays from where the eyes truly are through the display's mask.");
  add_options(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kDone : kWrongUsage;
  }
  if (const Result<void> understood = understand(options); !understood) {
    std::fprintf(stderr, "%s\n", understood.error().text().c_str());
    return kWrongUsage;
  }
  const Result<void> done = run(options);
  if (!done) std::fprintf(stderr, "%s\n", done.error().text().c_str());
  return done ? kDone : kFailed;
}

}  // namespace
}  // namespace prismesh::viewer

int main(int argc, char** argv) { return prismesh::viewer::main_of(argc, argv); }
