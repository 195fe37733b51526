// The section of the quality panel that shows and sets criteria.
#pragma once

#include "kiosk/tools/quality/criteria_facts.h"
#include "kiosk/tools/quality/quality_facts.h"

namespace prismesh::kiosk::tools::quality {

/// Lays the section out (inside Gui::layout), and adds what the user asks for.
void criteria_section(const CriteriaFacts& facts, QualityActions& actions);

}  // namespace prismesh::kiosk::tools::quality
