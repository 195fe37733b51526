// The list of all tools. Nothing else names them all.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kiosk/tools/tool.h"
#include "kiosk/tools/tool_context.h"

namespace prismesh::kiosk {

/// Makes the tools, in the order in which they are asked.
std::vector<std::unique_ptr<tools::Tool>> make_tools(tools::ToolContext& context);

/// All commands with their keys, in the order in which help and menu show them: the tables of the tools, with those of the editor in
/// between.
std::span<const tools::KeyBinding> key_bindings();

}  // namespace prismesh::kiosk
