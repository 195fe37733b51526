// prismesh-figures: draws the figures of docs/display.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tests/optics/figures/figures.h"

namespace prismesh::optics {
namespace {

using viewer::LightImage;

constexpr int kSkipped = 77;  ///< drawing isn't possible here

int complain(const std::string& what, const Error& error) {
  std::fprintf(stderr, "%s: %s\n", what.c_str(), error.text().c_str());
  return 1;
}

/// Whether a stored picture matches the drawn one; another version of Mesa may round differently. Prints the differences.
bool is_current(const std::filesystem::path& kept, const LightImage& drawn) {
  const Result<LightImage> picture = viewer::read_picture(kept);
  if (!picture) return complain("prismesh-figures", picture.error()), false;
  bool same = picture->width == drawn.width && picture->height == drawn.height;
  if (same) {
    const std::vector<std::uint8_t> a = viewer::srgb_bytes(*picture), b = viewer::srgb_bytes(drawn);
    std::size_t off = 0;
    for (std::size_t i = 0; i < a.size(); ++i) off += std::abs(a[i] - b[i]) > 12;
    same = off * 500 < a.size();
  }
  if (!same) std::fprintf(stderr, "%s: isn't what is drawn today; draw it anew with prismesh-figures, and look at it\n", kept.c_str());
  return same;
}

/// Draws all figures into the folder, or compares them with the files there.
int draw_all(const std::filesystem::path& folder, bool check) {
  const auto stage = Stage::create();
  if (!stage) return complain("prismesh-figures", stage.error()), check ? kSkipped : 1;
  struct Figure {
    const char* name;
    std::function<Result<LightImage>(Stage&)> draw;
  };
  const Figure figures[] = {{"optics.png", [](Stage&) { return optics_figure(); }},
                            {"interlacing.png", interlacing_figure},
                            {"lines.png", lines_figure},
                            {"seen.png", seen_figure},
                            {"volume.png", volume_figure}};
  int status = 0;
  for (const Figure& figure : figures) {
    const Result<LightImage> drawn = figure.draw(**stage);
    if (!drawn) return complain(figure.name, drawn.error());
    if (check) {
      if (!is_current(folder / figure.name, *drawn)) status = 1;
      continue;
    }
    if (const Result<void> written = viewer::write_picture(folder / figure.name, *drawn); !written)
      return complain(figure.name, written.error());
    std::printf("%s\n", (folder / figure.name).c_str());
  }
  return status;
}

}  // namespace
}  // namespace prismesh::optics

int main(int argc, char** argv) {
  const bool check = argc == 3 && std::string(argv[1]) == "--check";
  if (check || (argc == 2 && argv[1][0] != '-')) return prismesh::optics::draw_all(argv[argc - 1], check);
  const bool asked = argc == 2 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h");
  std::fprintf(asked ? stdout : stderr,
               "prismesh-figures DIR            draws the pictures of docs/display into DIR\n"
               "prismesh-figures --check DIR    says which of those in DIR are no longer what is drawn\n");
  return asked ? 0 : 2;
}
