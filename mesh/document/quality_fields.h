// Computes fields of the shells' quality: a metric, the composite, the stable time step.
#pragma once

#include "base/error.h"
#include "base/units.h"
#include "mesh/document/field.h"
#include "mesh/model/model.h"
#include "mesh/quality/criteria.h"
#include "mesh/quality/metrics.h"
#include "mesh/quality/time_step.h"

namespace prismesh::mesh::document {

/// A metric of each shell that it applies to. Suggested limits: the quads' limits of warning and failing; the whole range if there are
/// none, and if parts have different limits.
Result<Field> metric_field(const Model& model, quality::Metric metric, const quality::SizedCriteria& criteria, LengthUnit unit);

/// quality::composite of each shell. Suggested limits: halfway to failing, and failing.
Result<Field> composite_field(const Model& model, const quality::SizedCriteria& criteria);

/// The stable time step of each shell whose material is known, TSSFAC included, in the deck's time unit. Suggested limits: twice the
/// smallest, and the smallest.
Result<Field> time_step_field(const Model& model, const TimeStepControl& control);

}  // namespace prismesh::mesh::document
