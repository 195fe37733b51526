#include "ipc/model/messages_json.h"

#include "ipc/wire/json_message.h"
#include "mesh/document/edit_fields.h"

// --- the definitions: each message's kind and its fields ---

namespace prismesh::json {

PRISMESH_MESSAGE(ipc::Hello, "hello", f("protocol", m.protocol), f("program", m.program));
PRISMESH_JSON_OBJECT(mesh::document::JudgingRule, f("on", m.on), f("target_size", m.target_size), f("criteria", m.criteria));
PRISMESH_MESSAGE(ipc::Open, "open", f("path", m.path), f("length_unit", m.length_unit), f("target_size", m.target_size),
                 f("criteria", m.criteria), f("rules", m.rules), f("discard", m.discard), f("keep", m.keep), f("sandboxed", m.sandboxed),
                 f("stored", m.stored));
PRISMESH_MESSAGE(ipc::Save, "save", f("path", m.path), f("becomes", m.becomes), f("asks", m.asks), f("stays_unsaved", m.stays_unsaved));
PRISMESH_MESSAGE(ipc::Close, "close", f("discard", m.discard), f("keep", m.keep));
PRISMESH_MESSAGE(ipc::ApplyEdit, "apply_edit", f("edit", m.edit));
PRISMESH_MESSAGE(ipc::GoTo, "go_to", f("generation", m.generation));
PRISMESH_MESSAGE(ipc::BeginDrag, "begin_drag", f("edit", m.edit));
PRISMESH_MESSAGE(ipc::DragStep, "drag_step", f("drag", m.drag), f("sequence", m.sequence), f("by", m.by), f("distance", m.distance),
                 f("degrees", m.degrees));
PRISMESH_MESSAGE(ipc::CommitDrag, "commit_drag", f("drag", m.drag));
PRISMESH_MESSAGE(ipc::CancelDrag, "cancel_drag", f("drag", m.drag));
PRISMESH_MESSAGE(ipc::Cancel, "cancel", f("keep", m.keep));
PRISMESH_MESSAGE(ipc::Count, "count", f("expr", m.expr), f("kind", m.kind));
PRISMESH_MESSAGE(ipc::GetQuality, "get_quality", f("metric", m.metric), f("damaged", m.damaged));
PRISMESH_MESSAGE(ipc::FindShells, "find_shells", f("metric", m.metric), f("from", m.from), f("to", m.to), f("damaged", m.damaged));
PRISMESH_MESSAGE(ipc::PreviewEdit, "preview_edit", f("edit", m.edit));
PRISMESH_MESSAGE(ipc::FindFollowedEdges, "find_followed_edges", f("edit", m.edit));
PRISMESH_MESSAGE(ipc::GetState, "get_state", );
PRISMESH_MESSAGE(ipc::GetHistory, "get_history", );
PRISMESH_MESSAGE(ipc::GetField, "get_field", f("field", m.field), f("generation", m.generation), f("against", m.against),
                 f("against_generation", m.against_generation), f("from", m.from), f("to", m.to));
PRISMESH_MESSAGE(ipc::GetContacts, "get_contacts", f("select", m.select), f("gap", m.gap), f("thickness", m.thickness));
PRISMESH_MESSAGE(ipc::GetWeldChecks, "get_weld_checks", f("edge_distance", m.edge_distance), f("pitch", m.pitch));
PRISMESH_JSON_OBJECT(ipc::WeldFound, f("kind", m.kind), f("words", m.words), f("at", m.at));
PRISMESH_MESSAGE(ipc::WeldChecks, "weld_checks", f("generation", m.generation), f("welds", m.welds), f("finding_count", m.finding_count),
                 f("findings", m.findings), f("search_ns", m.search_ns));
PRISMESH_JSON_OBJECT(ipc::ContactVector, f("node", m.node), f("to", m.to));
PRISMESH_JSON_OBJECT(ipc::ContactRegion, f("kind", m.kind), f("a", m.a), f("b", m.b), f("name_a", m.name_a), f("name_b", m.name_b),
                     f("shells_a", m.shells_a), f("shells_b", m.shells_b), f("length", m.length), f("max_depth", m.max_depth),
                     f("mean_depth", m.mean_depth), f("area", m.area), f("at", m.at), f("worst_a", m.worst_a), f("worst_b", m.worst_b),
                     f("joined", m.joined), f("contact", m.contact), f("why", m.why), f("thickness_from", m.thickness_from),
                     f("shells", m.shells), f("curve", m.curve), f("vectors", m.vectors));
PRISMESH_MESSAGE(ipc::Contacts, "contacts", f("generation", m.generation), f("perforations", m.perforations),
                 f("penetrations", m.penetrations), f("clearances", m.clearances), f("regions", m.regions),
                 f("without_thickness", m.without_thickness), f("search_ns", m.search_ns));
PRISMESH_JSON_OBJECT(ipc::Camera, f("pivot", m.pivot), f("rotation", m.rotation), f("mm_per_unit", m.mm_per_unit),
                     f("stands_mm", m.stands_mm));
PRISMESH_MESSAGE(ipc::ShareCamera, "share_camera", f("camera", m.camera));
PRISMESH_MESSAGE(ipc::CameraMoved, "camera_moved", f("client", m.client), f("camera", m.camera));
PRISMESH_MESSAGE(ipc::GetSnapshot, "get_snapshot", f("generation", m.generation), f("have_segments", m.have_segments));
PRISMESH_MESSAGE(ipc::ReturnSnapshot, "return_snapshot", f("lease", m.lease));
PRISMESH_MESSAGE(ipc::FollowPen, "follow_pen", f("placement", m.placement), f("turn", m.turn), f("shift_mm", m.shift_mm),
                 f("scale", m.scale));
PRISMESH_MESSAGE(ipc::LeavePen, "leave_pen", );
PRISMESH_MESSAGE(ipc::PenFollowed, "pen_followed", );
PRISMESH_MESSAGE(ipc::Welcome, "welcome", f("protocol", m.protocol), f("version", m.version), f("client", m.client));
PRISMESH_MESSAGE(ipc::DocumentState, "state", f("open", m.open), f("busy", m.busy), f("path", m.path), f("length_unit", m.length_unit),
                 f("length_unit_guessed", m.length_unit_guessed), f("target_size", m.target_size),
                 f("target_size_guessed", m.target_size_guessed), f("generation", m.generation), f("nodes", m.nodes), f("shells", m.shells),
                 f("parts", m.parts), f("selected_nodes", m.selected_nodes), f("counts", m.counts), f("can_undo", m.can_undo),
                 f("can_redo", m.can_redo), f("changed", m.changed), f("recovered_edits", m.recovered_edits),
                 f("journalled_edits", m.journalled_edits), f("history_bytes", m.history_bytes), f("history_cap", m.history_cap),
                 f("generations", m.generations), f("files", m.files), f("warnings", m.warnings), f("stored", m.stored));
PRISMESH_JSON_OBJECT(ipc::ListedGeneration, f("number", m.number), f("made_by", m.made_by));
PRISMESH_JSON_OBJECT(ipc::DeckFile, f("name", m.name), f("shells", m.shells), f("parts", m.parts));
PRISMESH_JSON_OBJECT(ipc::HistoryBranch, f("number", m.number), f("fork", m.fork), f("generations", m.generations));
PRISMESH_MESSAGE(ipc::History, "history", f("generation", m.generation), f("generations", m.generations), f("branches", m.branches));
PRISMESH_MESSAGE(ipc::Saved, "saved", f("path", m.path), f("nodes_written", m.nodes_written), f("lines_changed", m.lines_changed),
                 f("notes", m.notes));
PRISMESH_MESSAGE(ipc::SaveWould, "save_would", f("replace", m.replace), f("make", m.make));
PRISMESH_MESSAGE(ipc::Edited, "edited", f("report", m.report), f("generation", m.generation));
PRISMESH_MESSAGE(ipc::FieldMade, "field", f("field", m.field), f("title", m.title), f("unit", m.unit), f("of", m.of),
                 f("against", m.against), f("generation", m.generation), f("on_nodes", m.on_nodes), f("measured", m.measured),
                 f("min", m.min), f("mean", m.mean), f("max", m.max), f("min_at", m.min_at), f("max_at", m.max_at), f("clear", m.clear),
                 f("full", m.full), f("new_nodes", m.new_nodes), f("shells_without", m.shells_without));
PRISMESH_MESSAGE(ipc::Counted, "counted", f("nodes", m.nodes), f("shells", m.shells), f("parts", m.parts));
PRISMESH_MESSAGE(ipc::Quality, "quality", f("generation", m.generation), f("metrics", m.metrics), f("metric", m.metric), f("bars", m.bars),
                 f("errors", m.errors), f("error_count", m.error_count), f("parts", m.parts));
PRISMESH_JSON_OBJECT(ipc::QualityMetric, f("name", m.name), f("unit", m.unit), f("warn", m.warn), f("fail", m.fail));
PRISMESH_JSON_OBJECT(ipc::QualityBar, f("from", m.from), f("to", m.to), f("open_below", m.open_below), f("open_above", m.open_above),
                     f("ok", m.ok), f("warn", m.warn), f("fail", m.fail));
PRISMESH_JSON_OBJECT(ipc::QualityError, f("shell", m.shell), f("metric", m.metric), f("unit", m.unit), f("value", m.value),
                     f("fail", m.fail), f("at", m.at), f("node", m.node));
PRISMESH_JSON_OBJECT(ipc::QualityPart, f("part", m.part), f("shells", m.shells), f("warn", m.warn), f("fail", m.fail),
                     f("composite", m.composite), f("least_composite", m.least_composite), f("target_size", m.target_size),
                     f("size_from", m.size_from), f("criteria", m.criteria));
PRISMESH_MESSAGE(ipc::ShellsFound, "shells_found", f("shells", m.shells), f("expr", m.expr));
PRISMESH_JSON_OBJECT(ipc::PreviewedGap, f("at", m.at), f("why", m.why));
PRISMESH_MESSAGE(ipc::EditPreviewed, "edit_previewed", f("generation", m.generation), f("report", m.report), f("points", m.points),
                 f("shells", m.shells), f("shell_count", m.shell_count), f("replaced", m.replaced), f("lines", m.lines),
                 f("line_count", m.line_count), f("left_out", m.left_out));
PRISMESH_MESSAGE(ipc::FollowedEdges, "followed_edges", f("generation", m.generation), f("nodes", m.nodes), f("edge_count", m.edge_count),
                 f("halfway", m.halfway));
PRISMESH_JSON_OBJECT(ipc::PreviewedShell, f("shell", m.shell), f("corners", m.corners), f("warn", m.warn), f("fail", m.fail),
                     f("clusters", m.clusters));
PRISMESH_MESSAGE(ipc::DragBegun, "drag_begun", f("drag", m.drag), f("base_generation", m.base_generation), f("nodes", m.nodes),
                 f("grab", m.grab), f("grab_position", m.grab_position), f("normal", m.normal));
PRISMESH_MESSAGE(ipc::Snapshot, "snapshot", f("lease", m.lease), f("generation", m.generation), f("segments", m.segments),
                 f("new_segments", m.new_segments));
PRISMESH_MESSAGE(ipc::GenerationPublished, "generation_published", f("generation", m.generation), f("made_by", m.made_by),
                 f("history_bytes", m.history_bytes), f("history_cap", m.history_cap));
PRISMESH_MESSAGE(ipc::DocumentOpened, "document_opened", f("path", m.path));
PRISMESH_MESSAGE(ipc::DocumentClosed, "document_closed", );
PRISMESH_MESSAGE(ipc::ProgressMade, "progress_made", f("what", m.what), f("fraction", m.fraction), f("doing", m.doing),
                 f("seconds", m.seconds));
PRISMESH_MESSAGE(ipc::DragEnded, "drag_ended", f("drag", m.drag), f("committed", m.committed), f("why", m.why));
PRISMESH_JSON_OBJECT(mesh::quality::Counts, f("ok", m.ok), f("warn", m.warn), f("fail", m.fail));
PRISMESH_JSON_OBJECT(mesh::deck::Warning, f("file", m.file), f("line", m.line), f("kind", m.kind), f("message", m.message),
                     f("count", m.count));
PRISMESH_JSON_OBJECT(mesh::document::StoppedRepair, f("attempt", m.attempt), f("steps", m.steps), f("round", m.round),
                     f("max_rounds", m.max_rounds), f("bad_before", m.bad_before), f("bad_left", m.bad_left));
PRISMESH_JSON_OBJECT(mesh::document::RegionLeft, f("a", m.a), f("b", m.b), f("why", m.why));
PRISMESH_JSON_OBJECT(mesh::document::Separated, f("regions_before", m.regions_before), f("regions_removed", m.regions_removed),
                     f("regions_left", m.regions_left), f("depth_before", m.depth_before), f("depth_after", m.depth_after),
                     f("largest_move", m.largest_move));
PRISMESH_JSON_OBJECT(mesh::document::SpotLeft, f("at", m.at), f("why", m.why));
PRISMESH_JSON_OBJECT(mesh::document::Welded, f("welds_added", m.welds_added), f("spots_left", m.spots_left), f("left_out", m.left_out));
PRISMESH_JSON_OBJECT(mesh::document::EditReport, f("edit", m.edit), f("nodes_moved", m.nodes_moved), f("largest_move", m.largest_move),
                     f("elements_added", m.elements_added), f("elements_removed", m.elements_removed), f("before", m.before),
                     f("after", m.after), f("clusters_before", m.clusters_before), f("clusters_after", m.clusters_after),
                     f("triangle_pairs", m.triangle_pairs), f("stopped", m.stopped), f("separated", m.separated), f("welded", m.welded),
                     f("inverted", m.inverted), f("lost_connections", m.lost_connections), f("lost", m.lost),
                     f("mass_before", m.mass_before), f("mass_after", m.mass_after), f("cog_before", m.centre_before),
                     f("cog_after", m.centre_after), f("notes", m.notes), f("ms", m.milliseconds));

}  // namespace prismesh::json

namespace prismesh::ipc {

Result<std::string> encode_request(std::uint64_t number, const Request& request) { return json_message::encode_request(number, request); }

std::string encode_answer(std::uint64_t to, const Answer& answer, std::size_t descriptors) {
  return json_message::encode_answer(to, answer, descriptors);
}

std::string answer_fields(const Answer& answer) { return json_message::answer_fields(answer); }

std::string encode_event(const Event& event) { return json_message::encode_event(event); }

tl::expected<NumberedRequest, BadRequest> decode_request(std::string_view line) { return json_message::decode_request<Request>(line); }

Result<FromDaemon> decode_from_daemon(std::string_view line) { return json_message::decode_said<Answer, Event>(line); }

}  // namespace prismesh::ipc
