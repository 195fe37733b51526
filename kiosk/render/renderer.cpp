#include "kiosk/render/renderer.h"

#include <algorithm>
#include <limits>
#include <string_view>
#include <tuple>
#include <utility>

#include "kiosk/render/composition.h"
#include "kiosk/render/eye_images.h"
#include "kiosk/render/flat_pass.h"
#include "kiosk/render/item_image.h"
#include "kiosk/render/model_layer.h"
#include "kiosk/render/scene_pass.h"
#include "kiosk/render/shaders.h"
#include "kiosk/render/weave_pass.h"

namespace prismesh::kiosk::render {

namespace {

constexpr double kMinViewerMm = 20;
/// By which an image takes some 25 ms on two cores, and few milliseconds on a graphics card.
constexpr std::size_t kMovingTrianglesInSoftware = 60'000;
constexpr std::size_t kMovingTriangles = 4'000'000;
constexpr double kHalfGapPixels = 4;  ///< half the width of the ground between two views
constexpr std::size_t kFirstPiece = 20'000, kSmallestPiece = 1'000, kLargestPiece = 1'000'000'000;  ///< elements

/// The input from which the scene in the eyes' images was drawn.
struct DrawnScene {
  Picture picture;
  std::vector<ComposedImage> images;
  int width = 0, height = 0;
  std::uint64_t scene_version = 0;
  bool coarse = false;  ///< drawn as one in motion

  /// Whether the same is seen, coarse or not.
  bool same_scene(const DrawnScene& other) const {
    const auto facts = [](const DrawnScene& d) {
      const Picture& p = d.picture;
      return std::tie(p.view, p.profile.optics.pixel_pitch_mm, p.colour, p.element_edges, p.outlines, p.thickness, p.quality_glyphs,
                      p.damaged_only, p.marked, p.marked_point, p.selected_nodes, p.handle, p.cut_handle, p.pen, p.followed_edges,
                      p.halfway_line, p.measures, p.shadows, p.field, p.two_views, d.images, d.width, d.height, d.scene_version);
    };
    return facts(*this) == facts(other);
  }
};

/// Whether two pictures agree in all that their composition depends on.
bool same_composition(const Picture& a, const Picture& b) {
  const auto facts = [](const Picture& p) {
    return std::tie(p.profile, p.between_eyes_mm, p.toward_right, p.eye_separation_mm, p.depth_share, p.mask_mm, p.panel);
  };
  return facts(a) == facts(b);
}

/// How many elements are drawn before the clock is looked at again, after so many took that time.
std::size_t next_count(std::size_t count, std::int64_t took_ns, std::int64_t budget_ns) {
  const double share = std::clamp(static_cast<double>(budget_ns) / static_cast<double>(took_ns), 0.5, 2.0);
  return std::clamp(static_cast<std::size_t>(static_cast<double>(count) * share), kSmallestPiece, kLargestPiece);
}

std::size_t bytes_of_items(int width, int height) {
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 8;  // items and depth
}

EyeView eye_view(const Picture& picture, const ComposedImage& image, int width, int height) {
  EyeView view;
  const Eigen::Vector2d screen = stereo::screen_size_mm(picture.profile, width, height);
  view.eye_mm = image.eye_mm;
  view.range = stereo::depth_range(picture.view, view.eye_mm);
  if (picture.pen) view.range = stereo::with_depth(view.range, view.eye_mm, stereo::to_screen(picture.view, picture.pen->tip).z());
  view.clip_from_screen = stereo::clip_onto(image.from_picture, stereo::clip_from_screen(view.eye_mm, screen, view.range), width, height);
  view.mm_per_pixel = screen.x() / width;
  view.viewer_mm = std::max(picture.between_eyes_mm.z(), kMinViewerMm);
  view.image = {image.eye, image.width, image.height, width, height, image.from_picture};
  return view;
}

/// An overlay may have changed any OpenGL state.
void reset_after_overlay() {
  for (const GLenum capability : {GL_BLEND, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_CULL_FACE, GL_STENCIL_TEST, GL_DITHER})
    glDisable(capability);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

}  // namespace

struct Renderer::Impl {
  RendererOptions options;
  Shaders shaders;
  ScenePass scene;
  FlatPass flat;
  ModelLayer layer;
  std::shared_ptr<const ModelSource> model;
  ModelLayer other_layer;
  std::shared_ptr<const ModelSource> other;
  std::array<FieldColours, 2> fields;
  PaintTexture paint;
  struct Images {
    EyeImages eyes;
    std::optional<DrawnScene> kept;  ///< the scene in them
  };
  Images fine;
  Images coarse;                    ///< without multisampling
  std::uint64_t scene_version = 0;  ///< increases with each change of the model or the preview
  Images* last = nullptr;           ///< of the last picture
  /// A scene that is drawn in pieces into `fine`.
  struct Pieces {
    DrawnScene scene;
    std::size_t image = 0;  ///< that is being drawn
    std::size_t done = 0;   ///< elements of it
    std::size_t count = 0;
  };
  std::optional<Pieces> pieces;
  std::size_t at_once = kFirstPiece;  ///< elements of a piece that are drawn before the clock is looked at
  WeavePass weave;
  // The last composition. Kept, as most pictures differ in nothing that it depends on.
  Composition composition;
  std::optional<DrawnScene> composed_for;

  // The item image, and the projection and the model's version it was drawn with.
  gl::Framebuffer item_framebuffer;
  gl::Texture item_colour;
  gl::Renderbuffer item_depth;
  ItemImage items;
  Eigen::Matrix4d items_clip = Eigen::Matrix4d::Zero();
  std::uint64_t items_version = 0;
  /// An item image that is drawn in pieces.
  struct ItemPieces {
    Eigen::Matrix4d clip;
    std::uint64_t version = 0;
    std::size_t done = 0;  ///< elements
  };
  std::optional<ItemPieces> item_pieces;
  std::size_t items_at_once = kFirstPiece;
  Figures figures;

  MemoryPlan plan;
  bool has_moved = false;  ///< a picture in motion was drawn
  /// What the levels took that were made last, and of how many shells they were.
  std::size_t levels_bytes = 0, levels_shells = 0;

  Impl(const RendererOptions& wanted, Shaders linked) : options(wanted), shaders(std::move(linked)), scene(shaders), flat(shaders) {}
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  std::size_t bytes_held() const;
  MemoryNeeds needs() const;
  MemoryNeeds needs_with(const ModelSource& source, const ModelLayer& into) const;
  Result<void> keep_to(const MemoryNeeds& wanted);
  Result<void> keep_to_limit(const Picture& picture, int width, int height);
  int samples_at_rest() const { return plan.given_up.multisampling ? 1 : options.samples; }
  /// The images that a moving picture is drawn into.
  Images& moving_images() { return plan.given_up.moving_images ? fine : coarse; }
  bool is_kept_at_rest(const DrawnScene& wanted) const { return fine.kept && !fine.kept->coarse && fine.kept->same_scene(wanted); }
  Result<void> draw_scene(Images& images, const Picture& picture, int width, int height, int samples);
  Result<void> prepare(Images& images, const Picture& picture, int samples);
  void draw_views(const Picture& picture, const EyeView& eye, int width, DrawSpan& span);
  Result<bool> draw_next(Pieces& next, Clock& clock, std::int64_t budget_ns);
  bool can_wait_with(const DrawnScene& wanted) const;
  void compose_for(const Picture& picture, int width, int height);
  bool make_item_buffer(int width, int height);
  void read_items(int width, int height);
  bool have_items(const stereo::Aim& aim) const;
  bool draw_items(const stereo::Aim& aim, std::size_t count);
  const ItemImage& items_for(const stereo::Aim& aim);
};

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(const RendererOptions& options) {
  if (const auto context = gl::check_context(); !context) return fail(context.error());
  Result<Shaders> shaders = Shaders::link();
  if (!shaders) return fail(shaders.error());
  RendererOptions wanted = options;
  if (wanted.moving_triangles == 0) {
    const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    const bool software = name != nullptr && (std::string_view(name).find("llvmpipe") != std::string_view::npos ||
                                              std::string_view(name).find("softpipe") != std::string_view::npos);
    wanted.moving_triangles = software ? kMovingTrianglesInSoftware : kMovingTriangles;
  }
  return std::unique_ptr<Renderer>(new Renderer(std::make_unique<Impl>(wanted, std::move(*shaders))));
}

std::size_t Renderer::Impl::bytes_held() const {
  std::size_t bytes = layer.bytes_held() + other_layer.bytes_held() + fine.eyes.bytes_held() + coarse.eyes.bytes_held();
  bytes += scene.bytes_held() + flat.bytes_held() + weave.bytes_held() + paint.bytes_held();
  for (const FieldColours& field : fields) bytes += field.bytes_held();
  if (item_framebuffer) bytes += bytes_of_items(items.width, items.height);
  return bytes;
}

/// Those of what is held now.
MemoryNeeds Renderer::Impl::needs() const {
  MemoryNeeds needs;
  needs.fixed_bytes = bytes_held() - fine.eyes.bytes_held() - coarse.eyes.bytes_held();
  std::size_t shells = 0;
  for (const ModelLayer* each : {&layer, &other_layer}) {
    needs.fixed_bytes -= each->shell_draws().order_bytes() + each->shell_draws().levels_bytes();
    shells += each->empty() ? 0 : each->table().shell_count();
  }
  const EyeImages& any = fine.eyes.width() > 0 ? fine.eyes : coarse.eyes;
  needs.image_pixels = static_cast<std::size_t>(any.width()) * static_cast<std::size_t>(any.height());
  needs.samples = options.samples;
  needs.in_motion = has_moved;
  needs.order_bytes = ShellDraws::order_bytes_of(shells);
  if (!layer.empty() && layer.table().shell_count() == levels_shells) needs.levels_bytes = levels_bytes;
  return needs;
}

/// Those with a model in place of the one of a layer.
MemoryNeeds Renderer::Impl::needs_with(const ModelSource& source, const ModelLayer& into) const {
  MemoryNeeds wanted = needs();
  const std::size_t before = into.empty() ? 0 : ModelLayer::bytes_for(into.table().source());
  wanted.fixed_bytes += std::max(ModelLayer::bytes_for(source), before) - before;
  const std::size_t shells = source.size(ipc::SnapshotArray::shell_nodes);
  wanted.order_bytes += ShellDraws::order_bytes_of(shells);
  if (!into.empty()) wanted.order_bytes -= ShellDraws::order_bytes_of(into.table().shell_count());
  if (&into == &layer && shells != levels_shells) wanted.levels_bytes = 0;
  return wanted;
}

/// Gives up what the plan says, before anything new is held.
Result<void> Renderer::Impl::keep_to(const MemoryNeeds& wanted) {
  const MemoryPlan next = plan_memory(wanted, options.video_memory);
  const bool others = !(next.given_up == plan.given_up);
  plan = next;
  if (options.video_memory == 0 || !others) return {};
  if (fine.eyes.width() > 0 && fine.eyes.samples() != samples_at_rest()) {
    pieces.reset();
    fine = {};
  }
  if (plan.given_up.moving_images) coarse = {};
  if (fine.kept && fine.kept->coarse && !plan.given_up.moving_images) fine.kept.reset();
  pieces.reset();
  item_pieces.reset();
  if (plan.given_up.levels && !layer.empty())
    if (Result<void> done = layer.shell_draws().give_up_levels(layer.table()); !done) return done;
  for (ModelLayer* each : {&layer, &other_layer})
    if (Result<void> done = each->shell_draws().set_order_in_pieces(plan.given_up.order); !done) return done;
  return {};
}

/// For a picture that is about to be drawn.
Result<void> Renderer::Impl::keep_to_limit(const Picture& picture, int width, int height) {
  if (options.video_memory == 0) return {};
  has_moved = has_moved || picture.moving || picture.waiting;
  MemoryNeeds wanted = needs();
  const ComposedImage& first = composition.images.front();
  wanted.image_pixels = static_cast<std::size_t>(first.width) * static_cast<std::size_t>(first.height);
  if (item_framebuffer) wanted.fixed_bytes -= bytes_of_items(items.width, items.height);
  wanted.fixed_bytes += bytes_of_items(width, height);  // of the same size
  wanted.fixed_bytes -= weave.bytes_held();
  wanted.fixed_bytes += WeavePass::bytes_of_phases(composition.phases.columns, composition.phases.rows);
  if (picture.shadows) wanted.fixed_bytes += ShadowPass::max_bytes() - scene.shadow_bytes();
  return keep_to(wanted);
}

VideoMemory Renderer::video_memory() const {
  const std::size_t held = impl_->bytes_held();
  return {held, impl_->options.video_memory, impl_->plan.bytes, impl_->plan.given_up};
}

Result<void> Renderer::set_model(std::shared_ptr<const ModelSource> model) {
  if (model && impl_->options.video_memory > 0)
    if (Result<void> kept = impl_->keep_to(impl_->needs_with(*model, impl_->layer)); !kept) return kept;
  Result<void> done = impl_->layer.set_model(model);
  impl_->model = done ? std::move(model) : nullptr;
  ++impl_->scene_version;
  impl_->figures.chunks_uploaded = impl_->layer.chunks_uploaded();
  return done;
}

Result<void> Renderer::set_levels(MadeLevels made) {
  impl_->pieces.reset();  // shells are drawn in another order
  impl_->item_pieces.reset();
  Impl& impl = *impl_;
  if (impl.options.video_memory > 0 && !impl.layer.empty()) {
    const std::size_t shells = impl.layer.table().shell_count();
    impl.levels_shells = shells;
    impl.levels_bytes = RowTexture::bytes_for(made.levels.triangles.size(), kFourIndices) +
                        3 * sizeof(std::uint32_t) * std::min(impl.options.moving_triangles, 2 * shells);
    if (Result<void> kept = impl.keep_to(impl.needs()); !kept) return kept;
    if (impl.plan.given_up.levels) return {};
  }
  return impl.layer.set_levels(std::move(made));
}

bool Renderer::levels_are_current() const {
  return impl_->layer.empty() || impl_->plan.given_up.levels ||
         (impl_->layer.shell_draws().has_levels() && !impl_->layer.shell_draws().is_out_of_date());
}

Result<void> Renderer::set_other(std::shared_ptr<const ModelSource> model) {
  ++impl_->scene_version;
  if (model && impl_->options.video_memory > 0)
    if (Result<void> kept = impl_->keep_to(impl_->needs_with(*model, impl_->other_layer)); !kept) return kept;
  Result<void> done = impl_->other_layer.set_model(model);
  impl_->other = done ? std::move(model) : nullptr;
  return done;
}

const ModelSource* Renderer::other() const { return impl_->other.get(); }

Result<void> Renderer::set_field(Pane pane, std::span<const float> values, bool on_nodes) {
  ++impl_->scene_version;
  FieldColours& field = impl_->fields[static_cast<std::size_t>(pane)];
  field.clear();
  if (!values.empty() && impl_->options.video_memory > 0) {
    MemoryNeeds wanted = impl_->needs();
    wanted.fixed_bytes += std::max(FieldColours::bytes_for(values.size()), field.bytes_held()) - field.bytes_held();
    if (Result<void> kept = impl_->keep_to(wanted); !kept) return kept;
  }
  return values.empty() ? Result<void>() : field.set(values, on_nodes);
}

Result<void> Renderer::set_part_paints(std::span<const PartPaint> paints) {
  ++impl_->scene_version;
  impl_->items_version = 0;
  impl_->item_pieces.reset();
  return impl_->paint.set(paints);
}

const ModelSource* Renderer::model() const { return impl_->model.get(); }

const std::shared_ptr<const ModelSource>& Renderer::shared_model() const { return impl_->model; }

stereo::Box Renderer::bounds() const { return impl_->layer.shown_box(); }

stereo::View Renderer::fitted(const stereo::View& view, const Eigen::Vector2d& screen_mm, double eye_distance_mm) const {
  const stereo::Box turned = impl_->layer.empty() ? stereo::Box() : impl_->layer.table().visible_box(view.rotation);
  return stereo::fit_turned(view, turned, screen_mm, eye_distance_mm);
}

void Renderer::begin_preview(std::span<const mesh::NodeIndex> nodes, std::span<const mesh::ShellIndex> shells) {
  ++impl_->scene_version;
  impl_->layer.begin_preview(nodes, shells);
}

Result<void> Renderer::set_contact(ContactPicture picture) {
  ++impl_->scene_version;
  return impl_->layer.set_contact(std::move(picture));
}

Result<void> Renderer::set_cut(std::optional<CutPicture> cut) {
  ++impl_->scene_version;
  std::optional<CutPicture> beside = cut;
  if (beside) beside->segments = beside->beside;
  if (Result<void> done = impl_->other_layer.set_cut(std::move(beside)); !done) return done;
  return impl_->layer.set_cut(std::move(cut));
}

const std::optional<CutPicture>& Renderer::cut() const { return impl_->layer.cut(); }

bool Renderer::can_cut() { return gl::has_clip_distance(); }

Result<void> Renderer::update_preview(const ipc::PreviewFrame& frame) {
  ++impl_->scene_version;
  return impl_->layer.update_preview(frame);
}

Result<void> Renderer::show_change(const MeshChange& change) {
  ++impl_->scene_version;
  return impl_->layer.show_change(change);
}

void Renderer::end_preview() {
  ++impl_->scene_version;
  impl_->layer.end_preview();
}

Result<DrawReport> Renderer::draw(const Picture& picture, unsigned framebuffer, int width, int height) {
  impl_->compose_for(picture, width, height);
  if (Result<void> kept = impl_->keep_to_limit(picture, width, height); !kept) return fail(kept.error());
  DrawnScene wanted{picture, impl_->composition.images, width, height, impl_->scene_version};
  wanted.picture.overlay = nullptr;
  // A moving picture is drawn coarsely only if the fine images don't show its scene already.
  const bool fine = !(picture.moving || picture.waiting) || impl_->is_kept_at_rest(wanted);
  wanted.coarse = !fine;
  const bool waits = !fine && picture.waiting && impl_->can_wait_with(wanted);
  Impl::Images& images = waits ? *impl_->last : fine ? impl_->fine : impl_->moving_images();
  if (!waits && (!images.kept || images.kept->coarse != wanted.coarse || !images.kept->same_scene(wanted))) {
    if (&images == &impl_->fine || !impl_->pieces || !impl_->pieces->scene.same_scene(wanted)) impl_->pieces.reset();
    Picture scene = wanted.picture;
    scene.moving = !fine;
    if (Result<void> drawn = impl_->draw_scene(images, scene, width, height, fine ? impl_->samples_at_rest() : 1); !drawn)
      return fail(drawn.error());
    images.kept = std::move(wanted);
  }
  impl_->last = &images;
  const std::vector<ComposedImage>& composed = impl_->composition.images;
  for (std::size_t i = 0; i < composed.size(); ++i) {
    reset_after_overlay();
    images.eyes.bind_flat(static_cast<int>(i));
    impl_->flat.draw(picture, eye_view(picture, composed[i], width, height));
  }
  reset_after_overlay();
  if (Result<void> woven = impl_->weave.draw(impl_->composition, images.eyes, framebuffer, width, height); !woven)
    return fail(woven.error());
  DrawReport report;
  if (picture.quality_glyphs && !impl_->layer.empty()) {
    const Result<ModelLayer::Glyphs> glyphs = impl_->layer.glyphs(impl_->options.glyph_cap, picture.damaged_only);
    if (!glyphs) return fail(glyphs.error());
    report.glyphs = glyphs->model.count + glyphs->preview.count;
    report.glyphs_left_out = glyphs->left_out;
  }
  report.memory = video_memory();
  return report;
}

void Renderer::Impl::compose_for(const Picture& picture, int width, int height) {
  if (composed_for && composed_for->width == width && composed_for->height == height && same_composition(composed_for->picture, picture))
    return;
  composition = compose(picture, width, height);
  composed_for = DrawnScene{picture, {}, width, height, 0};
  composed_for->picture.overlay = nullptr;
}

Result<void> Renderer::Impl::draw_scene(Images& images, const Picture& picture, int width, int height, int samples) {
  images.kept.reset();
  if (Result<void> prepared = prepare(images, picture, samples); !prepared) return prepared;
  const std::vector<ComposedImage>& composed = composition.images;
  for (std::size_t i = 0; i < composed.size(); ++i) {
    DrawSpan whole;
    images.eyes.bind_scene();
    draw_views(picture, eye_view(picture, composed[i], width, height), width, whole);
    images.eyes.keep_scene(static_cast<int>(i));
  }
  ++figures.scenes_drawn;
  return {};
}

Result<void> Renderer::Impl::prepare(Images& images, const Picture& picture, int samples) {
  const ComposedImage& first = composition.images.front();
  if (Result<void> sized = images.eyes.resize(first.width, first.height, samples); !sized) return sized;
  if (Result<void> prepared = scene.prepare(picture, layer); !prepared) return prepared;
  if (picture.two_views) {
    Picture beside = picture;
    beside.shadows = false;
    if (Result<void> prepared = scene.prepare(beside, other_layer); !prepared) return prepared;
  }
  return {};
}

/// Whether the last picture's scene may stay while this one is drawn in pieces: moving pictures would cost as much, and it has the size.
bool Renderer::Impl::can_wait_with(const DrawnScene& wanted) const {
  if (layer.empty() || layer.shell_draws().has_levels() || last == nullptr || !last->kept) return false;
  const DrawnScene& kept = *last->kept;
  const auto same_size = [](const ComposedImage& a, const ComposedImage& b) { return a.width == b.width && a.height == b.height; };
  return kept.width == wanted.width && kept.height == wanted.height &&
         std::equal(kept.images.begin(), kept.images.end(), wanted.images.begin(), wanted.images.end(), same_size);
}

Result<bool> Renderer::draw_piece(const Picture& picture, int width, int height, Clock& clock, std::int64_t budget_ns) {
  Impl& impl = *impl_;
  impl.compose_for(picture, width, height);
  if (Result<void> kept = impl.keep_to_limit(picture, width, height); !kept) return fail(kept.error());
  DrawnScene wanted{picture, impl.composition.images, width, height, impl.scene_version};
  wanted.picture.overlay = nullptr;
  if (impl.is_kept_at_rest(wanted)) return true;
  if (!impl.pieces || !impl.pieces->scene.same_scene(wanted)) impl.pieces.emplace().scene = std::move(wanted);
  const ComposedImage& first = impl.composition.images.front();
  if (impl.fine.eyes.width() != first.width || impl.fine.eyes.height() != first.height) impl.fine.kept.reset();
  reset_after_overlay();
  const Result<bool> whole = impl.draw_next(*impl.pieces, clock, budget_ns);
  if (!whole) {
    impl.pieces.reset();
    return whole;
  }
  if (!*whole) return false;
  impl.fine.eyes.keep_aside();
  impl.fine.kept = std::move(impl.pieces->scene);
  impl.figures.pieces_drawn = impl.pieces->count;
  impl.pieces.reset();
  ++impl.figures.scenes_drawn;
  return true;
}

Result<bool> Renderer::Impl::draw_next(Pieces& next, Clock& clock, std::int64_t budget_ns) {
  const std::int64_t start = clock.now_ns();
  const Picture& picture = next.scene.picture;
  if (Result<void> prepared = prepare(fine, picture, samples_at_rest()); !prepared) return fail(prepared.error());
  ++next.count;
  std::int64_t now = start, took = 0;
  do {
    const std::int64_t before = now;
    DrawSpan span(next.done, next.done + at_once);
    fine.eyes.bind_scene();
    draw_views(picture, eye_view(picture, next.scene.images[next.image], next.scene.width, next.scene.height), next.scene.width, span);
    next.done += at_once;
    if (!span.leaves_some()) {
      if (!fine.eyes.put_aside(static_cast<int>(next.image))) return fail("OpenGL", "there is no graphics memory for a picture at rest");
      ++next.image;
      next.done = 0;
    }
    glFinish();
    now = clock.now_ns();
    took = std::max<std::int64_t>(now - before, 1);
    at_once = next_count(at_once, took, budget_ns);
    if (next.image == next.scene.images.size()) return true;
  } while (now - start + took <= budget_ns);
  return false;
}

/// Draws the model over the whole picture, or two views side by side.
void Renderer::Impl::draw_views(const Picture& picture, const EyeView& eye, int width, DrawSpan& span) {
  scene.begin(eye, span);
  if (!picture.two_views)
    return scene.draw(picture, {layer, fields[0], picture.field[0], paint}, eye, {options.glyph_cap, options.moving_triangles}, span);
  for (const Pane pane : {Pane::model, Pane::other}) {
    const bool right = (pane == Pane::model) == picture.two_views->model_on_right;
    Picture half = picture;
    half.view = stereo::pan(picture.view, {picture.two_views->shift_mm(right, eye.mm_per_pixel * width), 0});
    if (pane == Pane::other) {
      half.handle.reset();
      half.cut_handle.reset();
      half.pen.reset();
      half.followed_edges.clear();
      half.halfway_line.clear();
      half.marked.reset();
      half.marked_point.reset();
      half.shadows = false;
    }
    const double middle = picture.two_views->border * width;
    scene.begin_pane(eye, right ? middle + kHalfGapPixels : 0, right ? width : middle - kHalfGapPixels, span);
    const auto at = static_cast<std::size_t>(pane);
    ModelLayer& shown = pane == Pane::model ? layer : other_layer;
    scene.draw(half, {shown, fields[at], picture.field[at], paint}, eye, {options.glyph_cap, options.moving_triangles}, span);
  }
  glDisable(GL_STENCIL_TEST);
}

bool Renderer::Impl::make_item_buffer(int width, int height) {
  if (item_framebuffer && items.width == width && items.height == height) return true;
  GLint max_size = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &max_size);
  if (width < 1 || height < 1 || width > max_size || height > max_size) return false;
  item_colour = gl::Texture::make();
  item_depth = gl::Renderbuffer::make();
  item_framebuffer = gl::Framebuffer::make();
  glBindTexture(GL_TEXTURE_2D, item_colour.get());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32UI, width, height);
  glBindRenderbuffer(GL_RENDERBUFFER, item_depth.get());
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glBindFramebuffer(GL_FRAMEBUFFER, item_framebuffer.get());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, item_colour.get(), 0);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, item_depth.get());
  items = {width, height, {}};
  items_version = 0;
  return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

void Renderer::Impl::read_items(int width, int height) {
  const std::size_t pixels = static_cast<std::size_t>(width) * height;
  items.items.resize(pixels);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  // Every driver can read four channels. Reading the one channel of the texture, where the driver offers it, saves three quarters.
  GLint format = 0, type = 0;
  glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_FORMAT, &format);
  glGetIntegerv(GL_IMPLEMENTATION_COLOR_READ_TYPE, &type);
  if (format == GL_RED_INTEGER && type == GL_UNSIGNED_INT) {
    glReadPixels(0, 0, width, height, GL_RED_INTEGER, GL_UNSIGNED_INT, items.items.data());
    return;
  }
  std::vector<std::array<std::uint32_t, 4>> all(pixels);
  glReadPixels(0, 0, width, height, GL_RGBA_INTEGER, GL_UNSIGNED_INT, all.data());
  for (std::size_t i = 0; i < pixels; ++i) items.items[i] = all[i][0];
}

bool Renderer::Impl::have_items(const stereo::Aim& aim) const {
  return items.width == aim.width && items.height == aim.height && items_version == layer.shape_version() &&
         items_clip == aim.clip_from_deck() && !items.items.empty();
}

/// Draws the next `count` elements, and reads the image if it is whole. Returns whether it is, or can't be drawn.
bool Renderer::Impl::draw_items(const stereo::Aim& aim, std::size_t count) {
  if (have_items(aim)) return true;
  const Eigen::Matrix4d clip = aim.clip_from_deck();
  if (items.width != aim.width || items.height != aim.height) item_pieces.reset();
  if (!make_item_buffer(aim.width, aim.height)) {
    items = {};
    item_pieces.reset();
    return true;
  }
  if (!item_pieces || item_pieces->version != layer.shape_version() || item_pieces->clip != clip)
    item_pieces = ItemPieces{clip, layer.shape_version()};
  items_version = 0;  // what was read before is drawn over
  const std::size_t end = item_pieces->done + std::min(count, std::numeric_limits<std::size_t>::max() - item_pieces->done);
  DrawSpan span(item_pieces->done, end);
  glBindFramebuffer(GL_FRAMEBUFFER, item_framebuffer.get());
  glViewport(0, 0, aim.width, aim.height);
  scene.draw_items(layer, paint, clip, span);
  item_pieces->done = end;
  if (span.leaves_some()) return false;
  read_items(aim.width, aim.height);
  items_clip = clip;
  items_version = item_pieces->version;
  item_pieces.reset();
  ++figures.item_buffers_drawn;
  return true;
}

const ItemImage& Renderer::Impl::items_for(const stereo::Aim& aim) {
  draw_items(aim, std::numeric_limits<std::size_t>::max());
  return items;
}

bool Renderer::draw_items_piece(const stereo::Aim& aim, Clock& clock, std::int64_t budget_ns) {
  Impl& impl = *impl_;
  if (impl.layer.empty()) return true;
  const std::int64_t start = clock.now_ns();
  std::int64_t now = start, took = 0;
  do {
    const std::int64_t before = now;
    if (impl.draw_items(aim, impl.items_at_once)) return true;
    glFinish();
    now = clock.now_ns();
    took = std::max<std::int64_t>(now - before, 1);
    impl.items_at_once = next_count(impl.items_at_once, took, budget_ns);
  } while (now - start + took <= budget_ns);
  return false;
}

std::optional<mesh::ShellIndex> Renderer::shell_at(const stereo::Aim& aim, const Eigen::Vector2d& pixel) {
  if (impl_->layer.empty() || !(pixel.minCoeff() >= 0 && pixel.maxCoeff() < 1e6)) return std::nullopt;
  const std::uint32_t shell = impl_->items_for(aim).shell_at(static_cast<int>(pixel.x()), static_cast<int>(pixel.y()));
  if (shell >= impl_->layer.table().shell_count()) return std::nullopt;
  return mesh::ShellIndex(shell);
}

std::optional<mesh::NodeIndex> Renderer::node_near(const stereo::Aim& aim, const Eigen::Vector2d& pixel, double radius) {
  if (impl_->layer.empty()) return std::nullopt;
  return NodeFinder(impl_->layer.table(), impl_->items_for(aim), aim, impl_->layer.cut()).nearest(pixel, radius, impl_->layer.line_nodes());
}

mesh::NodeSet Renderer::nodes_in(const stereo::Aim& aim, const PixelRect& rect, bool through) {
  if (impl_->layer.empty()) return {};
  const ItemImage none;
  const ItemImage& image = through ? none : impl_->items_for(aim);
  return NodeFinder(impl_->layer.table(), image, aim, impl_->layer.cut()).inside(rect, through, impl_->layer.visible_nodes());
}

Renderer::Figures Renderer::figures() const {
  Figures figures = impl_->figures;
  figures.moving_triangles = impl_->layer.shell_draws().chosen_triangles();
  figures.moving_pixels = impl_->layer.shell_draws().chosen_pixels();
  figures.bytes_uploaded = impl_->layer.bytes_uploaded() + impl_->other_layer.bytes_uploaded();
  for (const FieldColours& field : impl_->fields) figures.bytes_uploaded += field.bytes_uploaded();
  return figures;
}

}  // namespace prismesh::kiosk::render
