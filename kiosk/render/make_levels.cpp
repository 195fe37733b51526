#include "kiosk/render/make_levels.h"

#include <limits>
#include <utility>

#include "kiosk/render/model_copy.h"

namespace prismesh::kiosk::render {

Result<MadeLevels> make_levels(const ModelSource& source, const Progress& progress) {
  MadeLevels made;
  made.origin.setConstant(std::numeric_limits<double>::quiet_NaN());
  made.document = source.document_key();
  made.shell_versions = shell_versions_of(source);
  ModelCopy copy;
  copy.update(source);
  const mesh::Model& model = copy.model();
  made.places.reserve(model.node_count());
  for (std::size_t n = 0; n < model.node_count() && !made.origin.allFinite(); ++n) made.origin = model.positions[n];
  if (!made.origin.allFinite()) made.origin.setZero();
  for (std::size_t n = 0; n < model.node_count(); ++n) made.places.emplace_back((model.positions[n] - made.origin).cast<float>());
  Result<mesh::lod::Levels> levels = mesh::lod::build_levels(model, progress);
  if (!levels) return fail(std::move(levels.error()));
  made.levels = std::move(*levels);
  return made;
}

}  // namespace prismesh::kiosk::render
