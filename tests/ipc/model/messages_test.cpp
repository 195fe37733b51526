#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "ipc/model/messages_json.h"
#include "ipc/model/roles.h"
#include "ipc/wire/failure.h"

namespace prismesh::ipc {
namespace {

std::string refusal(std::string_view line) {
  const auto request = decode_request(line);
  return request ? "accepted" : request.error().message;
}

TEST(Messages, requests_survive_a_round_trip) {
  Open open;
  open.path = "/decks/car \"7\".k";
  open.target_size = 0.1;
  const auto back = decode_request(encode_request(12, open).value());
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->number, 12u);
  EXPECT_EQ(std::get<Open>(back->request).path, open.path);
  EXPECT_EQ(std::get<Open>(back->request).target_size, 0.1);
  EXPECT_FALSE(std::get<Open>(back->request).length_unit);

  const auto step = decode_request(encode_request(0, DragStep{3, 4, {1.0 / 3, -0.0, 1e-300}, 0.1}).value());
  ASSERT_TRUE(step);
  EXPECT_EQ(std::get<DragStep>(step->request).by[0], 1.0 / 3);
  EXPECT_EQ(std::get<DragStep>(step->request).by[2], 1e-300);

  const auto follow = decode_request(encode_request(1, FollowPen{7, {0, 0.6, 0, 0.8}, {1.0 / 3, -2, 3}, 0.1}).value());
  ASSERT_TRUE(follow) << follow.error().message;
  const auto& followed = std::get<FollowPen>(follow->request);
  EXPECT_EQ(followed.placement, 7u);
  EXPECT_EQ(followed.turn, (std::array<double, 4>{0, 0.6, 0, 0.8}));
  EXPECT_EQ(followed.shift_mm, (std::array<double, 3>{1.0 / 3, -2, 3}));
  EXPECT_EQ(followed.scale, 0.1);

  const auto count = decode_request(encode_request(2, Count{"part:3", mesh::select::EntityKind::part}).value());
  ASSERT_TRUE(count) << count.error().message;
  EXPECT_EQ(std::get<Count>(count->request).expr, "part:3");
  EXPECT_EQ(std::get<Count>(count->request).kind, mesh::select::EntityKind::part);
  EXPECT_NE(refusal(R"({"request": "count", "number": 1, "kind": "nodes"})").find("must be \"node\", \"element\" or \"part\""),
            std::string::npos);

  const auto contacts = decode_request(encode_request(3, GetContacts{"part:7", 0.25, 1.5}).value());
  ASSERT_TRUE(contacts) << contacts.error().message;
  EXPECT_EQ(std::get<GetContacts>(contacts->request).select, "part:7");
  EXPECT_EQ(std::get<GetContacts>(contacts->request).gap, 0.25);
  EXPECT_EQ(std::get<GetContacts>(contacts->request).thickness, 1.5);

  const auto state = decode_request(encode_request(4, GoTo{~std::uint64_t{0}}).value());
  ASSERT_TRUE(state) << state.error().message;
  EXPECT_EQ(std::get<GoTo>(state->request).generation, ~std::uint64_t{0});

  mesh::document::Select select;
  select.expr = "1-100";
  const auto edit = decode_request(encode_request(5, ApplyEdit{select}).value());
  ASSERT_TRUE(edit) << edit.error().message;
  EXPECT_EQ(std::get<mesh::document::Select>(std::get<ApplyEdit>(edit->request).edit).expr, "1-100");
}

TEST(Messages, answers_and_events_survive_a_round_trip) {
  DocumentState state;
  state.open = true;
  state.generation = ~std::uint64_t{0};
  state.counts = {1, 2, 3};
  state.history_bytes = 17;
  state.files.push_back({"parts/hood.k", 12, {3, 7}});
  state.warnings.push_back({"a.k", 7, "missing-include", "it isn't there", 2});
  const Result<FromDaemon> answer = decode_from_daemon(encode_answer(9, state, 1));
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_EQ(answer->to, 9u);
  EXPECT_EQ(answer->descriptors, 1u);
  const DocumentState& back = std::get<DocumentState>(std::get<Answer>(answer->message));
  EXPECT_EQ(back.generation, state.generation);
  EXPECT_EQ(back.counts, state.counts);
  ASSERT_EQ(back.warnings.size(), 1u);
  EXPECT_EQ(back.warnings[0].line, 7);
  EXPECT_EQ(back.history_bytes, 17u);
  ASSERT_EQ(back.files.size(), 1u);
  EXPECT_EQ(back.files[0].name, "parts/hood.k");
  EXPECT_EQ(back.files[0].parts, (std::vector<std::int64_t>{3, 7}));

  const Result<FromDaemon> edges = decode_from_daemon(encode_answer(9, FollowedEdges{7, {3, 4, 4, 5}, 2, {{0.5, 1, 2, 3, 4, 1e-9}}}, 0));
  ASSERT_TRUE(edges) << edges.error().text();
  EXPECT_EQ(std::get<FollowedEdges>(std::get<Answer>(edges->message)).nodes, (std::vector<std::uint32_t>{3, 4, 4, 5}));
  EXPECT_EQ(std::get<FollowedEdges>(std::get<Answer>(edges->message)).halfway,
            (std::vector<std::array<double, 6>>{{0.5, 1, 2, 3, 4, 1e-9}}));

  const Result<FromDaemon> event = decode_from_daemon(encode_event(DragEnded{4, true, "why"}));
  ASSERT_TRUE(event) << event.error().text();
  EXPECT_EQ(std::get<DragEnded>(std::get<Event>(event->message)).drag, 4u);
}

TEST(Messages, a_stopped_repair_survives_the_way) {
  const auto cancel = decode_request(encode_request(3, Cancel{true}).value());
  ASSERT_TRUE(cancel) << cancel.error().message;
  EXPECT_TRUE(std::get<Cancel>(cancel->request).keep);
  EXPECT_FALSE(std::get<Cancel>(decode_request(R"({"request": "cancel"})")->request).keep);
  const Result<FromDaemon> event = decode_from_daemon(encode_event(ProgressMade{"repair", 0.5, "round 3", 25}));
  ASSERT_TRUE(event) << event.error().text();
  const auto& made = std::get<ProgressMade>(std::get<Event>(event->message));
  EXPECT_EQ(made.doing, "round 3");
  EXPECT_EQ(made.seconds, 25u);
  Edited edited;
  edited.report.stopped = mesh::document::StoppedRepair{2, {77, 0}, 3, 20, 1109, 41};
  const Result<FromDaemon> answer = decode_from_daemon(encode_answer(1, edited, 0));
  ASSERT_TRUE(answer) << answer.error().text();
  const auto& stopped = std::get<Edited>(std::get<Answer>(answer->message)).report.stopped;
  ASSERT_TRUE(stopped);
  EXPECT_EQ(stopped->attempt, 2);
  EXPECT_EQ(stopped->steps, (std::vector<std::uint64_t>{77, 0}));
  EXPECT_EQ(stopped->round, 3);
  EXPECT_EQ(stopped->max_rounds, 20);
  EXPECT_EQ(stopped->bad_before, 1109u);
  EXPECT_EQ(stopped->bad_left, 41u);
}

TEST(Messages, what_was_separated_survives_the_way) {
  Edited edited;
  edited.report.welded = mesh::document::Welded{5, 1, {{{1.5, 2, 3}, "a weld is there already"}}};
  edited.report.separated = mesh::document::Separated{3, 2, {{"part:1", "", "half through"}}, 1.5, 0.25, 0.75};
  const Result<FromDaemon> answer = decode_from_daemon(encode_answer(1, edited, 0));
  ASSERT_TRUE(answer) << answer.error().text();
  const auto& separated = std::get<Edited>(std::get<Answer>(answer->message)).report.separated;
  ASSERT_TRUE(separated);
  EXPECT_EQ(separated->regions_before, 3u);
  EXPECT_EQ(separated->regions_removed, 2u);
  ASSERT_EQ(separated->regions_left.size(), 1u);
  EXPECT_EQ(separated->regions_left[0].a, "part:1");
  EXPECT_EQ(separated->regions_left[0].b, "");
  EXPECT_EQ(separated->regions_left[0].why, "half through");
  EXPECT_EQ(separated->depth_before, 1.5);
  EXPECT_EQ(separated->depth_after, 0.25);
  EXPECT_EQ(separated->largest_move, 0.75);
}

TEST(Messages, an_error_survives_the_way_as_an_answer) {
  const auto sent = [](const Error& error) {
    const Result<FromDaemon> message = decode_from_daemon(encode_answer(1, failed_from(error)));
    return error_from(std::get<Failed>(std::get<Answer>(message.value().message)));
  };
  EXPECT_EQ(sent({"a.k", 7, "is wrong"}).text(), "a.k:7: is wrong");
  EXPECT_FALSE(is_cancelled(sent({"a.k", 7, "is wrong"})));
  EXPECT_EQ(encode_answer(1, failed_from(cancelled())), R"({"answer":"failed","file":"","line":0,"message":"cancelled","to":1})");
  EXPECT_TRUE(is_cancelled(sent(cancelled())));
}

TEST(Messages, errors_name_the_field_and_the_nearest_known_one) {
  EXPECT_EQ(refusal(R"({"request": "opn", "number": 1})"), "unknown kind \"opn\"; the nearest is \"open\"");
  EXPECT_EQ(refusal(R"({"request": "open", "pth": "a.k"})"), "\"open\": has no field \"pth\"; the nearest is \"path\"");
  EXPECT_EQ(refusal(R"({"request": "open", "path": 7})"), "\"open\": field \"path\" must be a text in quotes");
  EXPECT_EQ(refusal(R"({"request": "commit_drag", "drag": -1})"), "\"commit_drag\": field \"drag\" must not be negative");
  EXPECT_EQ(refusal(R"({"request": "commit_drag", "drag": 1.5})"), "\"commit_drag\": field \"drag\" must be a whole number");
  EXPECT_EQ(refusal(R"({"request": "drag_step", "by": [1, 2]})"), "\"drag_step\": field \"by\" must be a list of three numbers");
  EXPECT_EQ(refusal(R"({"request": "cancel", "keep": "yes"})"), "\"cancel\": field \"keep\" must be true or false");
  EXPECT_EQ(refusal(R"({"request": "close", "discard": 1})"), "\"close\": field \"discard\" must be true or false");
  EXPECT_EQ(refusal(R"({"request": "hello", "protocol": 99999999999})"), "\"hello\": field \"protocol\" is too large");
  EXPECT_EQ(refusal(R"({"number": 1})"), "field \"request\" is missing");
  EXPECT_EQ(refusal("[1, 2]"), "it isn't a JSON object");
  EXPECT_EQ(refusal("{"), "it isn't JSON");
  EXPECT_NE(refusal(R"({"request": "apply_edit", "edit": {"edit": "tranlsate", "by": [0, 0, 1]}})").find("translate"), std::string::npos);
}

TEST(Messages, a_refusal_keeps_the_requests_number) {
  const auto request = decode_request(R"({"request": "nothing", "number": 17})");
  ASSERT_FALSE(request);
  EXPECT_EQ(request.error().number, 17u);
}

TEST(Messages, unknown_fields_of_a_newer_daemon_are_passed_over) {
  const Result<FromDaemon> answer = decode_from_daemon(R"({"answer": "done", "to": 3, "mood": "sunny"})");
  ASSERT_TRUE(answer) << answer.error().text();
  EXPECT_TRUE(std::holds_alternative<Done>(std::get<Answer>(answer->message)));
}

TEST(Messages, a_line_of_brackets_is_refused_before_it_is_parsed) {
  EXPECT_EQ(refusal(std::string(1'000'000, '[')), "it is nested too deeply");
  EXPECT_EQ(refusal(R"({"request": "open", "path": "[[[[[[[[[[[[[[[[[[[["})"), "accepted");
  EXPECT_EQ(refusal(R"({"request": "open", "path": "\"[[[[[[[[[[[[[[[[[[[["})"), "accepted") << "the quote is of the text";
  EXPECT_EQ(refusal(R"({"request": "open", "path": "\\", "x": )" + std::string(20, '[')), "it is nested too deeply")
      << "the text has ended";
  std::string objects;
  for (int i = 0; i < 20; ++i) objects += R"({"a":)";
  EXPECT_EQ(refusal(objects), "it is nested too deeply");
  std::string side_by_side = R"({"request": "open", "path": "a", "criteria": [)";
  for (int i = 0; i < 20; ++i) side_by_side += "[],{},";
  EXPECT_NE(refusal(side_by_side + "1]}"), "it is nested too deeply") << "none stands in another";
}

TEST(Messages, what_may_be_missing_may_be_null) {
  const auto save = decode_request(R"({"request": "save", "path": null, "number": 4})");
  ASSERT_TRUE(save) << save.error().message;
  EXPECT_FALSE(std::get<Save>(save->request).path);
  EXPECT_NE(refusal(R"({"request": "open", "path": null})"), "accepted");
  EXPECT_EQ(refusal("[]"), "it isn't a JSON object");
  EXPECT_EQ(refusal("\"open\""), "it isn't a JSON object");
}

TEST(Messages, text_that_is_not_utf8_is_refused_one_way_and_replaced_the_other) {
  Open open;
  open.path = "/decks/caf\xe9.k";
  EXPECT_FALSE(encode_request(1, open));
  DocumentState state;
  state.path = open.path;
  EXPECT_TRUE(decode_from_daemon(encode_answer(1, state)));
}

TEST(Messages, broken_lines_are_refused_in_words) {
  const std::string sound = encode_request(7, DragStep{3, 4, {1, 2, 3}, 0.5}).value();
  std::mt19937 random(7);
  for (int i = 0; i < 20'000; ++i) {
    std::string broken = sound;
    for (unsigned k = random() % 4; k-- > 0;) broken[random() % broken.size()] = static_cast<char>(random());
    if (random() % 3 == 0) broken.resize(random() % broken.size());
    const auto request = decode_request(broken);
    if (!request) {
      EXPECT_FALSE(request.error().message.empty());
    }
  }
}

/// The kinds of requests for which a user with one role is enough.
template <class AnyRequest, std::size_t I = 0>
void requests_of(Role role, std::vector<std::size_t>& found) {
  if constexpr (I < std::variant_size_v<AnyRequest>) {
    if (Roles{role}.has(role_for(AnyRequest(std::in_place_index<I>)))) found.push_back(I);
    requests_of<AnyRequest, I + 1>(role, found);
  }
}
template <class Each>
std::size_t place_of() {
  return Request(std::in_place_type<Each>).index();
}

TEST(RolesOfRequests, are_these) {
  std::vector<std::size_t> looks{place_of<Hello>(),      place_of<Count>(),       place_of<GetQuality>(),
                                 place_of<FindShells>(), place_of<GetField>(),    place_of<GetState>(),
                                 place_of<GetHistory>(), place_of<GetSnapshot>(), place_of<ReturnSnapshot>()};
  std::vector<std::size_t> watch, edit, devices, offer, serve;
  requests_of<Request>(Role::watch, watch);
  requests_of<Request>(Role::edit, edit);
  requests_of<Request>(Role::devices, devices);
  requests_of<Request>(Role::offer, offer);
  requests_of<Request>(Role::serve, serve);
  EXPECT_THAT(watch, testing::UnorderedElementsAreArray(looks));
  const std::vector<std::size_t> of_devices{place_of<FollowPen>(), place_of<LeavePen>()};
  looks.insert(looks.end(), of_devices.begin(), of_devices.end());
  EXPECT_THAT(devices, testing::UnorderedElementsAreArray(looks)) << "of the document, a user of devices only looks";
  EXPECT_EQ(edit.size(), std::variant_size_v<Request> - of_devices.size()) << "all but those of devices";
  EXPECT_TRUE(offer.empty());
  EXPECT_TRUE(serve.empty());
}

TEST(RolesOfRequests, a_field_against_another_deck_needs_edit) {
  GetField field;
  EXPECT_EQ(role_for(field), Role::watch);
  field.against = "surface";
  EXPECT_EQ(role_for(field), Role::watch);
  field.against = "/home/other/secret.k";
  EXPECT_EQ(role_for(field), Role::edit) << "the daemon would read it with its own rights";
}

}  // namespace
}  // namespace prismesh::ipc
