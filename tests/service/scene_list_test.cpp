// Which scenes clients are told of: those that load_scene takes.
#include "service/render/scene_list.h"

#include <gtest/gtest.h>

#include "support/temporary_folder.h"

namespace lumulus::service {
namespace {

namespace fs = std::filesystem;

using Names = std::vector<std::string>;

TEST(SceneList, HasTheSceneFilesOfTheFolderItself) {
    const test::TemporaryFolder folder;
    for (const char* name : {"b.toml", "a.toml", "é.toml", "notes.txt", ".hidden.toml", "two\nlines.toml"})
        test::writeAll(folder / name, "");
    fs::create_directory(folder / "folder.toml");
    test::writeAll(folder / "folder.toml" / "inner.toml", "");
    EXPECT_EQ(sceneNames(folder.path()), (Names{"a.toml", "b.toml", "é.toml"}));
}

TEST(SceneList, LeavesOutLinksThatLeadElsewhere) {
    const test::TemporaryFolder folder, elsewhere;
    test::writeAll(folder / "inside.toml", "");
    test::writeAll(elsewhere / "secret.toml", "");
    fs::create_symlink(folder / "inside.toml", folder / "also.toml");
    fs::create_symlink(elsewhere / "secret.toml", folder / "outside.toml");
    fs::create_symlink(folder / "nowhere.toml", folder / "dangling.toml");
    EXPECT_EQ(sceneNames(folder.path()), (Names{"also.toml", "inside.toml"}));
}

TEST(SceneList, LeavesOutNamesThatNoMessageCanHold) {
    const test::TemporaryFolder folder;
    test::writeAll(folder / "latin-\xE9.toml", "");  // no UTF-8
    test::writeAll(folder / (std::string(200, 'x') + ".toml"), "");
    test::writeAll(folder / (std::string(195, 'y') + ".toml"), "");
    EXPECT_EQ(sceneNames(folder.path()), Names{std::string(195, 'y') + ".toml"});
}

TEST(SceneList, IsEmptyWhereThereIsNoFolder) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(sceneNames(folder / "none"), Names{});
}

}  // namespace
}  // namespace lumulus::service
