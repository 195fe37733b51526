// The real decks that PRISMESH_MODELS points to.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "mesh/deck/data/deck.h"
#include "mesh/deck/open.h"

namespace prismesh::test {

/// The folder of the real decks, if there is one.
inline std::optional<std::filesystem::path> real_decks() {
  const char* models = std::getenv("PRISMESH_MODELS");
  if (models == nullptr || !std::filesystem::exists(std::filesystem::path(models) / "counts.json")) return std::nullopt;
  return models;
}

/// The model of one of them, by its name in counts.json; an empty one, and a failure, if it doesn't open.
inline mesh::Model open_real(const std::filesystem::path& decks, const std::string& name) {
  std::ifstream in(decks / "counts.json");
  const auto counts = nlohmann::json::parse(in);
  auto opened = mesh::deck::open(decks / counts.at(name).at("main").get<std::string>());
  if (!opened) {
    ADD_FAILURE() << opened.error().text();
    return {};
  }
  return std::move(opened->model);
}

}  // namespace prismesh::test
