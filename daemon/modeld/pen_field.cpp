#include "daemon/modeld/pen_field.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <new>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "base/log.h"
#include "mesh/field/brick.h"
#include "mesh/field/guides.h"

namespace prismesh::modeld {

namespace {

constexpr std::chrono::milliseconds kFieldPeriod{4};
constexpr std::chrono::milliseconds kPauseWithoutMemory{1000};
/// What is older than 100 ms fades (drivers/haptics/limits.h), so a field that stays true is published again with a new time.
constexpr std::int64_t kFieldRenewalNs = 40'000'000;
/// Of a drag whose worst shell fails; drivers/haptics caps it again.
constexpr double kFullResistanceNewton = 2;
constexpr std::size_t kKeptStates = 4;  ///< the pen's process may be some fields behind
constexpr double kMaxPlaceMm = 1e6;     ///< of poses and shifts; no pen reaches farther
constexpr double kMaxScale = 1e6;       ///< and its inverse

bool is_place(const std::array<double, 3>& mm) {
  return std::all_of(mm.begin(), mm.end(), [](double each) { return std::abs(each) <= kMaxPlaceMm; });
}

template <class Pointed>
bool is_same_owner(const std::weak_ptr<Pointed>& a, const std::weak_ptr<Pointed>& b) {
  return !a.owner_before(b) && !b.owner_before(a);
}

}  // namespace

Result<mesh::field::Placement> placement_of(const ipc::FollowPen& request) {
  const auto& [w, x, y, z] = request.turn;
  const Eigen::Quaterniond turn(w, x, y, z);
  if (!(std::abs(turn.norm() - 1) < 1e-6)) return fail("follow_pen", "\"turn\" must be a unit quaternion, real part first");
  if (!is_place(request.shift_mm)) return fail("follow_pen", "\"shift_mm\" must be three numbers up to a million");
  if (!(request.scale >= 1 / kMaxScale && request.scale <= kMaxScale))
    return fail("follow_pen", "\"scale\" must be above 0: from a millionth to a million");
  return mesh::field::Placement{turn.normalized().toRotationMatrix(), mesh::Vec3(request.shift_mm.data()), request.scale};
}

Result<ipc::Descriptor> PenField::follow(ipc::PenPageReader pen, const mesh::field::Placement& placement, std::uint64_t number) {
  std::shared_ptr<ipc::HapticFieldPage> page;
  {
    const std::lock_guard lock(mutex_);
    if (followed_) page = followed_->page;
  }
  if (!page) {
    Result<ipc::HapticFieldPage> made = ipc::HapticFieldPage::create();
    if (!made) return fail(std::move(made.error()));
    page = std::make_shared<ipc::HapticFieldPage>(std::move(*made));
  }
  Result<ipc::Descriptor> shared = page->descriptor().duplicate();
  if (!shared) return fail(std::move(shared.error()));
  auto followed = std::make_shared<const Followed>(Followed{std::move(pen), placement, number, std::move(page)});
  {
    const std::lock_guard lock(mutex_);
    followed_.swap(followed);
  }
  wake_.notify_one();
  return shared;
}

void PenField::leave() {
  const std::lock_guard lock(mutex_);
  followed_.reset();
}

void PenField::show(const std::shared_ptr<const mesh::document::Document>& document) {
  Shown shown;
  if (document) shown = {0, document->generations[document->cursor], document->opened, {}};
  const std::lock_guard lock(mutex_);
  shown.count = shown_.count + 1;
  std::swap(shown_, shown);
}

void PenField::show_drag(std::optional<DragFeel> feel) {
  const std::lock_guard lock(mutex_);
  if (!shown_.drag && !feel) return;
  ++shown_.count;
  shown_.drag.swap(feel);  // the one before ends with the argument, after the lock
}

void PenField::run(const std::stop_token& stop) {
  // A pen's process that outlives this one must not take a generation of another life for one of this.
  last_generation_ = static_cast<std::uint64_t>(clock_.now_ns());
  std::unique_lock lock(mutex_);
  while (!stop.stop_requested()) {
    if (!followed_) {
      lock.unlock();
      forget();
      lock.lock();
      wake_.wait(lock, stop, [this] { return followed_ != nullptr; });
      continue;
    }
    const auto began = std::chrono::steady_clock::now();
    auto pause = kFieldPeriod;
    {
      const Turn turn{followed_, shown_, clock_.now_ns()};
      lock.unlock();
      try {
        step(turn);
      } catch (const std::bad_alloc&) {
        logging::error("there isn't enough memory for the haptic pen's field; the pen feels nothing");
        forget();
        pause = kPauseWithoutMemory;
      }
    }
    lock.lock();
    wake_.wait_until(lock, stop, began + pause, [] { return false; });
  }
}

void PenField::step(const Turn& turn) {
  if (states_.empty() || turn.shown.count != taken_.count) take(turn.shown);
  if (turn.followed != computed_for_) {
    computed_for_ = turn.followed;
    has_field_ = false;
  }
  const std::optional<ipc::PenState> pen = turn.followed->pen.state();
  const bool has_pose = pen && pen->measured_ns != 0 && is_place(pen->position_mm);
  if (has_pose) {
    const double way_mm = (mesh::Vec3(pen->position_mm.data()) - place_mm_).norm();
    if (!has_field_ || fields_[front_]->mesh_generation != states_.back().generation || way_mm >= mesh::field::fine_shape().spacing_mm / 2)
      return compute(turn, *pen);
  }
  if (!has_field_ || fields_[front_]->mesh_generation != states_.back().generation) return;
  HapticField& field = *fields_[front_];
  if (turn.now_ns - field.time_ns < kFieldRenewalNs) return;
  field.time_ns = turn.now_ns;
  publish(turn, field);
}

/// The model that is shown, or dragged, without the shells of hidden parts; null: no document is open.
std::shared_ptr<const mesh::Model> PenField::felt_model(const Shown& shown) {
  if (!shown.generation) return nullptr;
  const mesh::document::Generation& generation = *shown.generation;
  std::shared_ptr<const mesh::Model> whole(shown.generation, &generation.model);
  if (shown.drag) whole = shown.drag->model;
  const std::vector<mesh::document::PartState>& parts = *generation.parts;
  if (std::none_of(parts.begin(), parts.end(), [](const mesh::document::PartState& part) { return part.hidden; })) {
    felt_shells_.reset();
    return whole;
  }
  if (!felt_shells_ || felt_shells_->generation != generation.number || !is_same_owner(felt_shells_->opened, shown.opened)) {
    felt_shells_ = {generation.number, shown.opened, generation.model.shell_nodes};
    for (std::size_t s = 0; s < generation.model.shell_count(); ++s)
      if (const mesh::PartIndex part = generation.model.shell_parts[s]; part.valid() && parts[part.value].hidden)
        felt_shells_->nodes.set(s, mesh::ShellNodes{});
  }
  auto felt = std::make_shared<mesh::Model>(*whole);
  felt->shell_nodes = felt_shells_->nodes;
  return felt;
}

/// Brings the tree to what is shown. Its shells get a new number only if they differ.
void PenField::take(const Shown& shown) {
  model_ = felt_model(shown);
  if (!model_ || states_.empty() || !is_same_owner(shown.opened, taken_.opened)) {
    states_.clear();
    has_field_ = false;
    states_.push_back({model_ ? mesh::spatial::BoxTree(*model_) : mesh::spatial::BoxTree(), ++last_generation_});
  } else {
    ShellState next = states_.back();
    const mesh::spatial::BoxTree::Update update = next.tree.follow(*model_);
    if (update.changed.empty()) {
      states_.back().tree = std::move(next.tree);
    } else {
      next.generation = ++last_generation_;
      changed_.add(update.changed);
      states_.push_back(std::move(next));
      if (states_.size() > kKeptStates) states_.erase(states_.begin());
    }
  }
  taken_ = {shown.count, nullptr, shown.opened, {}};
}

void PenField::compute(const Turn& turn, const ipc::PenState& pen) {
  for (std::unique_ptr<HapticField>& field : fields_)
    if (!field) field = std::make_unique<HapticField>();
  const mesh::Vec3 place_mm(pen.position_mm.data());
  HapticField& field = *fields_[1 - front_];
  mesh::field::EarlierField earlier;
  if (has_field_) {
    const ShellState* had = state_of(pen.field_generation);
    if (had == nullptr) had = state_of(fields_[front_]->mesh_generation);
    if (had != nullptr) earlier = {fields_[front_].get(), {&had->tree, had->generation}, changed_};
  }
  mesh::field::fill_field({&states_.back().tree, states_.back().generation}, earlier, turn.followed->placement, place_mm, field);
  ++computed_;
  field.time_ns = turn.now_ns;
  field.placement = guides_.placement = turn.followed->number;
  guides_.count = 0;
  if (model_) mesh::field::find_guides(*model_, states_.back().tree, turn.followed->placement, place_mm, guides_);
  if (!publish(turn, field)) return;
  front_ = 1 - front_;
  has_field_ = true;
  place_mm_ = place_mm;
  changed_ = {};
}

/// What resists a drag's step.
HapticResistance PenField::resistance(const Turn& turn) {
  HapticResistance resistance{turn.followed->number, turn.now_ns, 0, {0, 0, 0}};
  if (!turn.shown.drag) return resistance;
  const mesh::document::Worsening& worsening = turn.shown.drag->worsening;
  if (worsening.direction.isZero()) return resistance;
  resistance.newton = kFullResistanceNewton * worsening.badness;
  Eigen::Map<mesh::Vec3>(resistance.direction) = turn.followed->placement.turn * worsening.direction;
  return resistance;
}

/// Publishes the field with what belongs to it. Returns false if this pen isn't followed any more.
bool PenField::publish(const Turn& turn, const HapticField& field) {
  guides_.time_ns = turn.now_ns;
  const HapticResistance resisting = resistance(turn);
  const std::lock_guard lock(mutex_);
  if (followed_ != turn.followed) return false;
  // The reader copies guides and resistance when a new field arrives.
  turn.followed->page->set_guides(guides_);
  turn.followed->page->set_resistance(resisting);
  turn.followed->page->publish(field);
  return true;
}

const PenField::ShellState* PenField::state_of(std::uint64_t generation) const {
  const auto found = std::find_if(states_.begin(), states_.end(), [&](const ShellState& each) { return each.generation == generation; });
  return found == states_.end() ? nullptr : &*found;
}

void PenField::forget() {
  states_.clear();
  states_.shrink_to_fit();
  taken_ = {};
  felt_shells_.reset();
  model_.reset();
  computed_for_.reset();
  fields_ = {};
  has_field_ = false;
  changed_ = {};
}

}  // namespace prismesh::modeld
