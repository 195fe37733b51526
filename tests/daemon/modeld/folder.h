// A temporary folder that is removed with the test, and decks in it.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/station/sheet_deck.h"

namespace prismesh::test {

class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "prismesh-modeld-XXXXXX").string();
    path_ = ::mkdtemp(name.data());
    std::filesystem::create_directory(path_ / "state");
    std::filesystem::permissions(path_ / "state", std::filesystem::perms::owner_all);
  }
  ~Folder() {
    std::error_code problem;
    std::filesystem::remove_all(path_, problem);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path state() const { return path_ / "state"; }
  /// The curved sheet of the station's tests.
  std::filesystem::path sheet(const std::string& name = "sheet.k") const {
    write_sheet(path_ / name);
    return path_ / name;
  }
  std::filesystem::path uneven_sheet(int side) const {
    write_uneven_sheet(path_ / "uneven.k", side);
    return path_ / "uneven.k";
  }
  /// Two quads in two files: nodes 1 to 3 in the main file, 4 to 6 in the include.
  std::filesystem::path two_files() const {
    std::ofstream(path_ / "main.k") << "*KEYWORD\n*NODE\n"
                                       "       1             0.0             0.0             0.0\n"
                                       "       2             1.0             0.0             0.0\n"
                                       "       3             2.0             0.0             0.0\n"
                                       "*INCLUDE\nrest.k\n*END\n";
    std::ofstream(path_ / "rest.k") << "*NODE\n"
                                       "       4             0.0             1.0             0.0\n"
                                       "       5             1.0             1.0             0.0\n"
                                       "       6             2.0             1.0             0.0\n"
                                       "*ELEMENT_SHELL\n"
                                       "       1       1       1       2       5       4\n"
                                       "       2       1       2       3       6       5\n"
                                       "*PART\npanel\n         1         1         1\n";
    return path_ / "main.k";
  }

 private:
  std::filesystem::path path_;
};

}  // namespace prismesh::test
