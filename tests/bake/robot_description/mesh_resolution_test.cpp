// Where references to mesh files are looked for, and in which order.
#include <gmock/gmock.h>

#include "bake/robot_description/robot_texts.h"
#include "robot_description/mesh_resolver.h"
#include "support/mesh_files.h"

namespace galactic::test::mesh_resolution_test {
namespace {

namespace fs = std::filesystem;
using bake::MeshResolution;
using bake::MeshResolver;
using bake::RobotImportOptions;
using testing::HasSubstr;
using testing::Not;

/// A folder with a URDF at ws/src/pkg_description/robots/r.urdf.
class MeshReferences : public testing::Test {
 protected:
  [[nodiscard]] fs::path put(const std::string& file) const {
    return folder_.write(file, "x").lexically_normal();
  }
  [[nodiscard]] MeshResolution resolve(const std::string& reference) const {
    return MeshResolver(urdf_, options_).resolve(reference);
  }

  ScratchFolder folder_;
  fs::path urdf_ = folder_.write("ws/src/pkg_description/robots/r.urdf", "x");
  RobotImportOptions options_;
};

TEST_F(MeshReferences, ToPackagesTryNamedOnesThenTheSearchPathThenFoldersAbove) {
  const std::string reference = "package://pkg/meshes/m.stl";
  const fs::path above = put("ws/src/pkg/meshes/m.stl");
  const fs::path searched = put("share/pkg/meshes/m.stl");
  const fs::path named = put("elsewhere/meshes/m.stl");
  EXPECT_EQ(resolve(reference).file, above);
  options_.search_roots = {folder_.path() / "nowhere", folder_.path() / "share"};
  EXPECT_EQ(resolve(reference).file, searched);
  EXPECT_EQ(resolve(reference).how, "package search path");
  options_.packages["pkg"] = folder_.path() / "elsewhere";
  EXPECT_EQ(resolve(reference).file, named);
  EXPECT_EQ(resolve(reference).how, "`package` pkg");
  EXPECT_FALSE(resolve(reference).guessed);
}

TEST_F(MeshReferences, SayWhenPackagesWereSearchedFor) {
  (void)put("share/pkg/meshes/m.stl");
  const fs::path deep = put("share/deep/down/arm/meshes/m.stl");
  options_.search_roots = {folder_.path() / "share"};
  MeshResolver resolver(urdf_, options_);
  (void)resolver.resolve("package://pkg/meshes/m.stl");
  EXPECT_FALSE(resolver.hasSearched());
  EXPECT_EQ(resolver.resolve("package://arm/meshes/m.stl").file, deep);
  EXPECT_TRUE(resolver.hasSearched());
}

TEST_F(MeshReferences, ToPackagesGoOnWhenTheFileIsNotInThePackage) {
  const fs::path above = put("ws/src/pkg/meshes/m.stl");
  options_.packages["pkg"] = folder_.path() / "elsewhere";
  EXPECT_EQ(resolve("package://pkg/meshes/m.stl").file, above);
}

TEST_F(MeshReferences, ThatDifferInCaseAreNotFoundButNamed) {
  (void)put("ws/src/pkg_description/meshes/Arm.STL");
  for (const char* reference : {"package://pkg_description/meshes/arm.stl", "../meshes/arm.stl"}) {
    const MeshResolution missing = resolve(reference);
    EXPECT_EQ(missing.file, "");
    EXPECT_THAT(missing.how, HasSubstr("where 'Arm.STL' differs in upper and lower case"));
  }
  EXPECT_THAT(resolve("../meshes/leg.stl").how, Not(HasSubstr("differs")));
}

TEST_F(MeshReferences, ToThePackageOfTheUrdfAreFoundByFolderName) {
  const fs::path mesh = put("ws/src/pkg_description/meshes/m.stl");
  const MeshResolution found = resolve("package://pkg_description/meshes/m.stl");
  EXPECT_EQ(found.file, mesh);
  EXPECT_EQ(found.how, "package above the robot's file");
  EXPECT_EQ(resolve("model://pkg_description/meshes/m.stl").file, mesh);
}

TEST_F(MeshReferences, ToThePackageOfTheUrdfAreFoundByItsPackageFile) {
  const fs::path mesh = put("ws/src/pkg_description/meshes/m.stl");
  (void)folder_.write("ws/src/pkg_description/package.xml",
                      "<package>\n  <name> renamed </name>\n</package>");
  const MeshResolution found = resolve("package://renamed/meshes/m.stl");
  EXPECT_EQ(found.file, mesh);
  EXPECT_EQ(found.how, "package above the robot's file");
}

TEST_F(MeshReferences, ToPackagesDeepInASearchRootAreFoundByTheirPackageFile) {
  const fs::path mesh = put("overlay/src/stack/folder/m.stl");
  (void)folder_.write("overlay/src/stack/folder/package.xml",
                      "<package><name>deep</name></package>");
  options_.search_roots = {folder_.path() / "overlay"};
  EXPECT_EQ(resolve("package://deep/m.stl").file, mesh);
}

TEST_F(MeshReferences, ToUnknownPackagesAreGuessedFromThePathInside) {
  const fs::path mesh = put("ws/src/pkg_description/meshes/m.stl");
  const MeshResolution found = resolve("package://no_such_package/meshes/m.stl");
  EXPECT_EQ(found.file, mesh);
  EXPECT_TRUE(found.guessed);
}

TEST_F(MeshReferences, WithoutPackageNameAreFound) {
  const fs::path mesh = put("ws/src/pkg_description/meshes/m.stl");
  EXPECT_EQ(resolve("package:///pkg_description/meshes/m.stl").file, mesh);
  EXPECT_EQ(resolve("package:///meshes/m.stl").file, mesh);
}

TEST_F(MeshReferences, ByPathAreRelativeToTheUrdf) {
  const fs::path mesh = put("ws/src/pkg_description/meshes/m.stl");
  const fs::path beside = put("ws/src/pkg_description/robots/beside.stl");
  EXPECT_EQ(resolve("../meshes/m.stl").file, mesh);
  EXPECT_EQ(resolve("../meshes/m.stl").how, "relative to the robot's file");
  EXPECT_EQ(resolve("beside.stl").file, beside);
  EXPECT_EQ(resolve("./beside.stl").file, beside);
  EXPECT_EQ(resolve("..\\meshes\\m.stl").file, mesh);
  EXPECT_EQ(resolve(mesh.string()).file, mesh);
  EXPECT_EQ(resolve("file://" + mesh.string()).file, mesh);
  EXPECT_EQ(resolve("file://beside.stl").file, beside);
  const MeshResolution guessed = resolve("meshes/m.stl");
  EXPECT_EQ(guessed.file, mesh);
  EXPECT_TRUE(guessed.guessed);
}

TEST_F(MeshReferences, LeadIntoPackagesAndTheUrdfsFoldersOnly) {
  const fs::path secret = put("secret/m.stl");
  const std::string relative = "../../../../secret/m.stl";
  for (const std::string& reference : {secret.string(), "file://" + secret.string(), relative,
                                       "package://pkg_description/" + relative}) {
    SCOPED_TRACE(reference);
    const MeshResolution refused = resolve(reference);
    EXPECT_TRUE(refused.file.empty());
    EXPECT_FALSE(refused.how.empty());
  }
  EXPECT_THAT(resolve(secret.string()).how, HasSubstr("`package` NAME=DIR or `allow-outside`"));
  options_.packages["secrets"] = secret.parent_path();
  EXPECT_EQ(resolve(secret.string()).file, secret);
  options_.packages.clear();
  options_.allow_outside = true;
  EXPECT_EQ(resolve(secret.string()).file, secret);
  EXPECT_EQ(resolve(relative).file, secret);
}

TEST_F(MeshReferences, AreNotGuessedOutsideOfPackagesAndTheUrdfsFolders) {
  const fs::path far = put("secret/m.stl");
  const fs::path near = put("ws/src/pkg_description/meshes/m.stl");
  for (const char* reference :
       {"secret/m.stl", "x/../../secret/m.stl", "package://no_such_package/secret/m.stl"}) {
    SCOPED_TRACE(reference);
    const MeshResolution refused = resolve(reference);
    EXPECT_TRUE(refused.file.empty()) << refused.file;
    EXPECT_EQ(refused.how,
              "../../../../secret/m.stl (from the robot's folder), which is there, but outside the "
              "robot's folders and packages; give `package` NAME=DIR or `allow-outside`");
  }
  EXPECT_EQ(resolve("meshes/m.stl").file, near);
  EXPECT_EQ(resolve("package://no_such_package/meshes/m.stl").file, near);
  options_.packages["secrets"] = far.parent_path();
  EXPECT_EQ(resolve("secret/m.stl").file, far);
  options_.packages.clear();
  options_.allow_outside = true;
  EXPECT_EQ(resolve("secret/m.stl").file, far);
  EXPECT_EQ(resolve("package://no_such_package/secret/m.stl").file, far);
  options_.allow_outside = false;
  // A package is within reach of all that lies in it.
  (void)folder_.write("package.xml", "<package><name>all</name></package>");
  EXPECT_EQ(resolve("secret/m.stl").file, far);
}

TEST_F(MeshReferences, MayHaveUriEscapes) {
  const fs::path mesh = put("ws/src/pkg_description/meshes/my mesh.stl");
  EXPECT_EQ(resolve("package://pkg_description/meshes/my%20mesh.stl").file, mesh);
  EXPECT_EQ(resolve("../meshes/my%20mesh.stl").file, mesh);
}

TEST_F(MeshReferences, ThatLeadNowhereSayWhereTheyWereLookedFor) {
  // Folders of this name above the test's are looked into, too.
  options_.packages["of_this_test"] = folder_.path() / "elsewhere";
  const MeshResolution named = resolve("package://of_this_test/meshes/m.stl");
  EXPECT_TRUE(named.file.empty());
  EXPECT_EQ(named.how, "../../../../elsewhere/meshes/m.stl (from the robot's folder)");
  const MeshResolution unknown = resolve("package://other/m.stl");
  EXPECT_THAT(unknown.how, HasSubstr("a folder 'other' or a package.xml of that name"));
  EXPECT_EQ(resolve("../m.stl").how, "../m.stl (from the robot's folder)");
  for (const char* odd : {"", "package://", "package:///", "package://nowhere", "http://host/m.stl",
                          "/", "..", "file://"}) {
    SCOPED_TRACE(odd);
    EXPECT_TRUE(resolve(odd).file.empty());
    EXPECT_FALSE(resolve(odd).how.empty());
  }
}

TEST_F(MeshReferences, DependOnThePackageFilesThatWereLookedInto) {
  const fs::path beside = put("ws/src/pkg_description/robots/arm/m.stl");
  const fs::path inside = put("ws/src/pkg_description/robots/m.stl");
  const fs::path package = urdf_.parent_path() / "package.xml";
  const auto name = [&](const char* called) {
    (void)folder_.write("ws/src/pkg_description/robots/package.xml",
                        fmt::format("<package><name>{}</name></package>", called));
  };
  name("other");
  MeshResolver before(urdf_, options_);
  EXPECT_EQ(before.resolve("package://arm/m.stl").file, beside);
  EXPECT_THAT(before.packageFiles(), testing::ElementsAre(package));
  name("arm");
  MeshResolver after(urdf_, options_);
  EXPECT_EQ(after.resolve("package://arm/m.stl").file, inside);
  EXPECT_THAT(after.packageFiles(), testing::ElementsAre(package));
  // Who asks for none depends on none.
  MeshResolver relative(urdf_, options_);
  EXPECT_EQ(relative.resolve("m.stl").file, inside);
  EXPECT_THAT(relative.packageFiles(), testing::IsEmpty());
}

TEST_F(MeshReferences, MakePackageFilesSourcesOfTheRobot) {
  (void)folder_.write("ws/arm/m.stl", stlBinaryFile(unevenBox()));
  (void)folder_.write("ws/package.xml", "<package><name>other</name></package>");
  const auto robot = bake::importRobot(folder_.write(
      "ws/r.urdf", robotText(linkText("a", "<mesh filename=\"package://arm/m.stl\"/>"))));
  ASSERT_TRUE(robot.has_value()) << robot.error().message;
  std::vector<std::string> names;
  for (const bake::SourceFile& file : robot->read.files) names.push_back(file.name);
  EXPECT_THAT(names, testing::ElementsAre("r.urdf", "arm/m.stl", "package.xml"));
}

}  // namespace
}  // namespace galactic::test::mesh_resolution_test
