// Names nodes, shells, cards and text in messages.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/deck/data/deck.h"

namespace prismesh::mesh::deck {

std::string node_name(const Model& model, NodeIndex node);     ///< "node 7"
std::string shell_name(const Model& model, ShellIndex shell);  ///< "shell 7"

/// A card with its id, where it has one: "*SET_NODE_LIST 1", "SPC1 7", "/GRNOD/NODE 3".
std::string card_name(Format format, const Referrer& card);
/// The same without its id: "*SET_NODE_LIST".
std::string keyword_name(Format format, const std::string& keyword);

/// The end of a sentence about an entity that unread text may name: "*FOO isn't read in this version, and may name it".
std::string unread_name(const Deck& deck, const UnreadText& unread);

/// The end of a sentence about a node or shell, with the first parameter in its card's text: "has numbers given by the parameter &name".
std::string has_parameter(std::string_view card);

/// The cards that name an id, in the deck's order, each once: "*SET_NODE_LIST 1 (deck.k:1234)". After `max` of them, how many more.
std::vector<std::string> what_names(const Deck& deck, Referred referred, std::int64_t id, std::size_t max = 10);

}  // namespace prismesh::mesh::deck
