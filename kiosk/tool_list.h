// The list of all tools. Nothing else names them all.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kiosk/toolkit/tool.h"
#include "kiosk/toolkit/tool_context.h"

namespace prismesh::kiosk {

/// Makes the tools, in the order in which they are asked.
std::vector<std::unique_ptr<toolkit::Tool>> make_tools(toolkit::ToolContext& context);

/// All commands with their keys, in the order in which help and menu show them: the tables of the tools, with those of the editor in
/// between.
std::span<const input::KeyBinding> key_bindings();

}  // namespace prismesh::kiosk
