#include "wingbeat/files/input_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "wingbeat/files/design_file.hpp"

namespace wingbeat {
namespace {

namespace fs = std::filesystem;

/// A folder of data with two vehicles and a study, which is that of the library meanwhile.
class ShippedData : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    folder = fs::temp_directory_path() / ("wingbeat-" + test);
    for (const char* name : {"designs/ours.toml", "designs/theirs.toml", "designs/notes.txt", "studies/hover.toml"}) {
      fs::create_directories((folder / name).parent_path());
      std::ofstream(folder / name) << "text\n";
    }
    set_shipped_data(folder);
  }
  void TearDown() override {
    set_shipped_data({});
    fs::remove_all(folder);
  }

  fs::path folder;
};

TEST_F(ShippedData, AreThoseOfTheFolderThatIsSet) {
  EXPECT_EQ(shipped_data(), folder);
  EXPECT_THAT(shipped_names(InputKind::vehicle), ::testing::ElementsAre("ours", "theirs"));
  EXPECT_THAT(shipped_names(InputKind::study), ::testing::ElementsAre("hover"));
  EXPECT_THAT(shipped_names(InputKind::bench), ::testing::IsEmpty());
  EXPECT_EQ(find_input("ours", InputKind::vehicle), fs::canonical(folder / "designs/ours.toml"));
  EXPECT_EQ(find_input("hover.toml", InputKind::study), fs::canonical(folder / "studies/hover.toml"));
  EXPECT_EQ(find_vehicle("elsewhere", "theirs"), fs::canonical(folder / "designs/theirs.toml"));
}

TEST_F(ShippedData, AreNamedWhereANameIsNear) {
  try {
    find_input("our", InputKind::vehicle);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "our: no such file, and no design of that name comes with the program; did you mean ours?");
  }
  // A name with a folder is no name of theirs.
  EXPECT_EQ(find_input("folder/ours", InputKind::vehicle), fs::path("folder/ours"));
}

TEST_F(ShippedData, AreThoseOfTheProgramOtherwise) {
  set_shipped_data({});
  EXPECT_NE(shipped_data(), folder);
}

}  // namespace
}  // namespace wingbeat
