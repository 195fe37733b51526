#include "kiosk/render/memory_plan.h"

#include <array>

#include "kiosk/render/eye_images.h"

namespace prismesh::kiosk::render {

namespace {

constexpr std::size_t kMegabyte = std::size_t{1} << 20;

std::size_t bytes_of(const MemoryNeeds& needs, const GivenUp& given_up) {
  const int samples = given_up.multisampling ? 1 : needs.samples;
  std::size_t bytes = needs.fixed_bytes + kMemoryMargin;
  bytes += needs.image_pixels * EyeImages::bytes_of_pixel(samples, true);
  if (needs.in_motion && !given_up.moving_images) bytes += needs.image_pixels * EyeImages::bytes_of_pixel(1, false);
  if (!given_up.order) bytes += needs.order_bytes;
  if (!given_up.levels) bytes += needs.levels_bytes;
  return bytes;
}

}  // namespace

MemoryPlan plan_memory(const MemoryNeeds& needs, std::size_t limit) {
  MemoryPlan plan;
  plan.bytes = bytes_of(needs, plan.given_up);
  if (limit == 0) return plan;
  constexpr std::array<bool GivenUp::*, 4> kOrder{&GivenUp::multisampling, &GivenUp::moving_images, &GivenUp::order, &GivenUp::levels};
  for (bool GivenUp::*const next : kOrder) {
    if (plan.bytes <= limit) break;
    plan.given_up.*next = true;
    plan.bytes = bytes_of(needs, plan.given_up);
  }
  return plan;
}

std::string megabytes_of(const VideoMemory& memory) {
  const std::string held = std::to_string((memory.held + kMegabyte - 1) / kMegabyte);
  return (memory.limit > 0 ? held + " of " + std::to_string(memory.limit / kMegabyte) : held) + " MB";
}

std::string in_words(const GivenUp& given_up) {
  std::string words;
  const auto add = [&](bool given, const char* what) {
    if (given) words += (words.empty() ? "" : ", ") + std::string(what);
  };
  add(given_up.multisampling, "edges aren't smoothed");
  add(given_up.moving_images, "the picture at rest is drawn again after each motion");
  add(given_up.order, "pictures at rest take longer");
  add(given_up.levels, "pictures in motion draw every shell, which is slow for large models");
  return words;
}

std::string sentence_of(const VideoMemory& memory) {
  std::string words = "Video memory is limited to " + std::to_string(memory.limit / kMegabyte) + " MB (video_memory_mb).";
  if (memory.given_up.any()) words += " To keep to it, " + in_words(memory.given_up) + ".";
  words += " Every shell is still drawn at rest, and can be picked.";
  if (memory.is_exceeded())
    words += " The limit is exceeded all the same: this model in this window takes up to " +
             std::to_string((memory.planned + kMegabyte - 1) / kMegabyte) + " MB.";
  return words;
}

}  // namespace prismesh::kiosk::render
