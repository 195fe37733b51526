// Which regions `separate` would remove.
#pragma once

#include "mesh/document/contacts.h"
#include "mesh/document/document.h"

namespace prismesh::mesh::document {

/// Sets `clear` and `why` of each region: whether the edit `separate` would remove it if it were the only one, with `joined`, the thickness
/// and the gap of the wish, and nothing else. `contacts`: what find_contacts() found in the current generation by this wish. Tries
/// the twenty worst: costs an edit each; of others `why` says that they weren't tried. Errors: as of find_contacts().
Result<void> find_clear(const Document& document, const ContactWish& wish, Contacts& contacts, const Progress& progress = {});

}  // namespace prismesh::mesh::document
