// prismesh-figures: draws the pictures of docs/display anew.
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include "tests/optics/figures/figures.h"

namespace prismesh::optics {
namespace {

using viewer::LightImage;

int complain(const std::string& what, const Error& error) {
  std::fprintf(stderr, "%s: %s\n", what.c_str(), error.text().c_str());
  return 1;
}

int draw_all(const std::filesystem::path& folder) {
  const auto stage = Stage::create();
  if (!stage) return complain("prismesh-figures", stage.error());
  struct Figure {
    const char* name;
    std::function<Result<LightImage>(Stage&)> draw;
  };
  const Figure figures[] = {{"optics.png", [](Stage&) { return optics_figure(); }},
                            {"interlacing.png", interlacing_figure},
                            {"lines.png", lines_figure},
                            {"seen.png", seen_figure},
                            {"volume.png", volume_figure}};
  for (const Figure& figure : figures) {
    const Result<LightImage> drawn = figure.draw(**stage);
    if (!drawn) return complain(figure.name, drawn.error());
    if (const Result<void> written = viewer::write_picture(folder / figure.name, *drawn); !written)
      return complain(figure.name, written.error());
    std::printf("%s\n", (folder / figure.name).c_str());
  }
  return 0;
}

}  // namespace
}  // namespace prismesh::optics

int main(int argc, char** argv) {
  if (argc == 2 && argv[1][0] != '-') return prismesh::optics::draw_all(argv[1]);
  const bool asked = argc == 2 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h");
  std::fprintf(asked ? stdout : stderr, "prismesh-figures DIR    draws the pictures of docs/display into DIR\n");
  return asked ? 0 : 2;
}
