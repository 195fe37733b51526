#include "mesh/contact/close_shells.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "mesh/contact/close_pair.h"
#include "mesh/contact/in_batches.h"
#include "mesh/contact/shares_node.h"
#include "mesh/contact/shell_triangles.h"

namespace prismesh::mesh::contact {

namespace {

constexpr std::size_t kCloseGrain = 1024;

/// The shells that are too close to one shell and not thicker: so each pair is found once, and no search is wider than its shell is thick.
void find_close_to(const Model& model, const spatial::BoxTree& tree, const ContactThickness& thickness, double gap, const ShellSet* among,
                   ShellIndex shell, std::vector<CloseShells>& found) {
  const double own = thickness.of_shell[shell.value];
  if (!(own > 0) || !tree.contains(shell)) return;
  const spatial::FloatBox box = tree.box_of(shell);
  const Vec3 low(box.low[0], box.low[1], box.low[2]), high(box.high[0], box.high[1], box.high[2]);
  if (!can_decide(low) || !can_decide(high)) return;
  CloseTo close_to(model, thickness, gap, shell);
  const std::size_t first = found.size();
  tree.near_box(low, high, own + gap, [&](ShellIndex other, const spatial::FloatBox& its_box) {
    const double its = thickness.of_shell[other.value];
    if (!(its > 0) || its > own || (its == own && !(shell < other))) return true;
    const double reach = close_to.reach(other);
    if (!(spatial::distance2(box, its_box) <= spatial::bound_of_square(reach * reach))) return true;
    if (share_a_node(model.shell(shell), model.shell(other))) return true;
    if (among != nullptr && !std::binary_search(among->begin(), among->end(), other)) return true;
    if (const auto close = close_to.pair(other)) found.push_back(*close);
    return true;
  });
  close_to.leave_out_neighbours(found, first);
}

}  // namespace

std::vector<CloseShells> find_close_shells(const Model& model, const spatial::BoxTree& tree, const ContactThickness& thickness, double gap,
                                           const ShellSet* among, const Progress& progress) {
  const std::size_t count = among != nullptr ? among->size() : model.shell_count();
  std::vector<std::vector<CloseShells>> of_range((count + kCloseGrain - 1) / kCloseGrain);
  const bool done = in_batches(count, kCloseGrain, progress, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const ShellIndex shell = among != nullptr ? (*among)[s] : ShellIndex(s);
      find_close_to(model, tree, thickness, gap, among, shell, of_range[begin / kCloseGrain]);
    }
  });
  if (!done) return {};
  std::vector<CloseShells> all;
  for (auto& some : of_range) all.insert(all.end(), some.begin(), some.end());
  std::sort(all.begin(), all.end(), [](const CloseShells& x, const CloseShells& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
  return all;
}

}  // namespace prismesh::mesh::contact
