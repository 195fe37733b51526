// Folder that a finished calibration is saved to.
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "drivers/settings/choose_profile.h"
#include "drivers/settings/settings.h"
#include "kiosk/calibrator.h"

namespace prismesh::kiosk {
namespace {

namespace fs = std::filesystem;

/// Sets or unsets an environment variable until the end of the scope.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    set(value);
  }
  ~Environment() { set(old_ ? old_->c_str() : nullptr); }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  void set(const char* value) const { value != nullptr ? ::setenv(name_, value, 1) : ::unsetenv(name_); }
  const char* name_;
  std::optional<std::string> old_;
};

TEST(CalibrationPlace, is_the_users_own_folder) {
  const Environment home("HOME", "/home/u"), config("XDG_CONFIG_HOME", nullptr);
  const SaveTo usual = usual_place(std::nullopt).value();
  EXPECT_EQ(usual.folder, "/home/u/.config/prismesh/displays");
  EXPECT_EQ(usual.settings, "/home/u/.config/prismesh/prismesh.toml");
  const SaveTo given = usual_place(fs::path("/srv/station.toml")).value();
  EXPECT_EQ(given.folder, "/home/u/.config/prismesh/displays");
  EXPECT_EQ(given.settings, "/srv/station.toml");
}

TEST(CalibrationPlace, without_a_home_is_beside_the_settings_where_they_find_it_again) {
  const Environment home("HOME", nullptr), config("XDG_CONFIG_HOME", nullptr);
  EXPECT_FALSE(usual_place(std::nullopt));
  for (const fs::path settings : {"/srv/station.toml", "conf/station.toml", "station.toml", "../station.toml"}) {
    const SaveTo place = usual_place(settings).value();
    const fs::path profile = place.folder / "wall.toml";
    EXPECT_EQ(fs::weakly_canonical(profile), fs::weakly_canonical(fs::absolute(settings).parent_path() / "displays" / "wall.toml"));
    const std::string text = drivers::settings::with_profile("", settings.string(), profile).value_or("");
    const Result<drivers::settings::StationSettings> read = drivers::settings::parse_settings(text, settings);
    ASSERT_TRUE(read);
    EXPECT_EQ(fs::weakly_canonical(read->display.profile), fs::weakly_canonical(profile)) << settings;
  }
}

}  // namespace
}  // namespace prismesh::kiosk
