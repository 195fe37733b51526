#include "mesh/deck/formats/formats.h"

#include <utility>

#include "mesh/deck/abaqus/reader.h"
#include "mesh/deck/abaqus/writer.h"
#include "mesh/deck/lsdyna/reader.h"
#include "mesh/deck/lsdyna/writer.h"
#include "mesh/deck/nastran/reader.h"
#include "mesh/deck/nastran/writer.h"
#include "mesh/deck/radioss/reader.h"
#include "mesh/deck/radioss/writer.h"

namespace prismesh::mesh::deck {

Result<DeckContents> read(Format format, FileSet files, Watch& watch) {
  switch (format) {
    case Format::abaqus: return abaqus::read(std::move(files), watch);
    case Format::radioss: return radioss::read(std::move(files), watch);
    case Format::nastran: return nastran::read(std::move(files), watch);
    case Format::ls_dyna: break;
  }
  return lsdyna::read(std::move(files), watch);
}

std::unique_ptr<const CardWriter> card_writer(Format format) {
  switch (format) {
    case Format::abaqus: return abaqus::card_writer();
    case Format::radioss: return radioss::card_writer();
    case Format::nastran: return nastran::card_writer();
    case Format::ls_dyna: break;
  }
  return lsdyna::card_writer();
}

}  // namespace prismesh::mesh::deck
