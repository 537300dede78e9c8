// Each thing that can be wrong with a mesh file has a message of its own.
#include <gmock/gmock.h>

#include "bake/import/import_helpers.h"

namespace galactic::test::errors_test {
namespace {

using bake::importMesh;
using bake::placeAndClean;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;

std::string glbWithNodes(const std::string& nodes) {
  return glbFile(unevenBox(), {.nodes = nodes, .buffer_uri = {}, .more = {}});
}

TEST(MeshErrors, SayThatAFileIsMissing) {
  const ScratchFolder folder;
  const auto asset = importMesh(folder.path() / "absent.glb");
  ASSERT_FALSE(asset.has_value());
  EXPECT_EQ(asset.error().code, ErrorCode::kIo);
  EXPECT_THAT(asset.error().where, EndsWith("absent.glb"));
  EXPECT_EQ(asset.error().message, "there is no such file; check the path");
}

TEST(MeshErrors, SayThatAFolderIsNoFile) {
  const ScratchFolder folder;
  const auto asset = importMesh(folder.path());
  ASSERT_FALSE(asset.has_value());
  EXPECT_EQ(asset.error().code, ErrorCode::kIo);
  EXPECT_EQ(asset.error().message, "it is a folder; give the path of a mesh file inside it");
}

TEST(MeshErrors, SayThatADeviceIsNoFile) {
  const auto asset = importMesh("/dev/null");
  ASSERT_FALSE(asset.has_value());
  EXPECT_EQ(asset.error().code, ErrorCode::kIo);
  EXPECT_EQ(asset.error().message, "it is not a regular file; give a mesh file");
}

TEST(MeshErrors, SayThatAFileIsEmpty) {
  const Error error = importError("empty.glb", "");
  EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
  EXPECT_EQ(error.message, "the file is empty; export or download it again");
}

TEST(MeshErrors, TellAPointerOfGitLfsFromAMesh) {
  for (const char* name : {"mug.glb", "mug.obj", "mug.DAE", "mug.ply", "mug.stl", "mug.fbx"}) {
    const Error error = importError(name,
                                    "version https://git-lfs.github.com/spec/v1\n"
                                    "oid sha256:4d7a2146\nsize 12345\n");
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput) << name;
    EXPECT_EQ(error.message,
              "is a pointer of Git LFS (fetch it with git lfs pull); expected a mesh")
        << name;
  }
}

TEST(MeshErrors, ListTheFormatsWhenNoneFits) {
  const Error error = importError("letter.odt", "text");
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_THAT(error.message, StartsWith("no reader knows the extension '.odt'; expected one of"));
  for (const char* format : {".glb", ".gltf", ".obj", ".ply", ".stl", ".dae", ".fbx"}) {
    EXPECT_THAT(error.message, HasSubstr(format));
  }
}

TEST(MeshErrors, SayWhatToDoWithXacroFiles) {
  const Error error = importError("arm.urdf.xacro", "<robot/>");
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_EQ(error.message,
            "it is a xacro file; expand it with the xacro tool and give the resulting .urdf");
}

TEST(MeshErrors, SayThatContentIsNoMesh) {
  for (const char* name : {"a.glb", "a.gltf", "a.ply", "a.dae", "a.fbx"}) {
    const Error error =
        importError(name, "\x89PNG\r\n this is a picture, not a mesh, whatever its name says");
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput) << name;
    EXPECT_THAT(error.message, StartsWith("its content cannot be read as .")) << name;
  }
}

TEST(MeshErrors, SayThatThereAreNoTriangles) {
  const Error points = importError("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
  EXPECT_EQ(points.code, ErrorCode::kInvalidInput);
  EXPECT_THAT(points.message, HasSubstr("no triangles"));
  const Error unplaced = importError("unplaced.glb", glbWithNodes(R"([{"name":"nothing"}])"));
  EXPECT_EQ(unplaced.message,
            "it has no triangles (0 meshes, 0 placed); expected a surface, not points, lines or an "
            "empty scene");
}

TEST(MeshErrors, NameTheMeshAndVertexThatIsNotFinite) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    MeshContent box = unevenBox();
    box.positions[6][1] = bad;
    const Error error = importError("box.ply", plyBinaryFile(box));
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    EXPECT_THAT(error.where, EndsWith("box.ply: mesh 0 'mesh 0'"));
    EXPECT_THAT(error.message, StartsWith("vertex "));
    EXPECT_THAT(error.message, HasSubstr("of triangle 2 "));
    EXPECT_THAT(error.message, EndsWith("which is not finite; repair the mesh"));
  }
}

TEST(MeshErrors, AcceptAVertexThatIsNotFiniteWhenNoTriangleUsesIt) {
  MeshContent box = unevenBox();
  box.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
  const auto asset = importContent("box.ply", plyBinaryFile(box));
  ASSERT_TRUE(asset.has_value()) << asset.error().message;
  const auto clean = placeAndClean(*asset);
  ASSERT_TRUE(clean.has_value());
  EXPECT_EQ(clean->mesh.vertices.size(), 8U);
}

TEST(MeshErrors, RefuseIndicesOutOfRange) {
  MeshContent box = unevenBox();
  box.triangles[4][2] = 8;
  for (const auto& [name, content] : {std::pair<std::string, std::string>{"box.obj", objFile(box)},
                                      {"ascii.ply", plyAsciiFile(box)},
                                      {"binary.ply", plyBinaryFile(box)},
                                      {"box.glb", glbFile(box)},
                                      {"box.dae", daeFile(box, {"Y_UP", "1", ""})}}) {
    EXPECT_EQ(importError(name, content).code, ErrorCode::kInvalidInput) << name;
  }
}

TEST(MeshErrors, AskForTheUnitOfAnAbsurdlyLargeScene) {
  const auto asset = importContent("mm.obj", "v 0 0 0\nv 9000 0 0\nv 0 0 3000\nf 1 2 3\n");
  ASSERT_TRUE(asset.has_value());
  const auto clean = placeAndClean(*asset);
  ASSERT_FALSE(clean.has_value());
  EXPECT_EQ(clean.error().code, ErrorCode::kInvalidInput);
  EXPECT_EQ(clean.error().where, "mm");
  EXPECT_EQ(
      clean.error().message,
      "it is 9000 m large and reaches 9000 m from the origin, but only 800 m are possible; is "
      "its unit the meter? Give `scale` 0.01 for centimeters or `scale` 0.001 for "
      "millimeters, or cut what is so large into parts");
}

TEST(MeshErrors, SuggestMovingASceneThatIsFarFromTheOrigin) {
  const auto asset = importContent("geo.obj", "v 5000 0 0\nv 5009 0 0\nv 5000 0 3\nf 1 2 3\n");
  ASSERT_TRUE(asset.has_value());
  const auto clean = placeAndClean(*asset);
  ASSERT_FALSE(clean.has_value());
  EXPECT_THAT(clean.error().message, HasSubstr("move it to the origin with `transform`"));
}

TEST(MeshErrors, NameTheNodeWhoseTransformFlattensOrIsNotFinite) {
  const Error flat =
      importError("a.glb", glbWithNodes(R"([{"mesh":0,"name":"hidden","scale":[1,0,1]}])"));
  EXPECT_EQ(flat.code, ErrorCode::kInvalidInput);
  EXPECT_THAT(flat.where, EndsWith("a.glb: node 'hidden'"));
  EXPECT_EQ(flat.message,
            "its transform flattens the mesh (a scale of 0); correct or remove the node");
  const Error infinite =
      importError("a.glb", glbWithNodes(R"([{"mesh":0,"name":"far","translation":[1e39,0,0]}])"));
  EXPECT_THAT(infinite.where, EndsWith("a.glb: node 'far'"));
  EXPECT_EQ(infinite.message,
            "its transform has a NaN or infinite element; correct the node or its parents");
}

TEST(MeshErrors, RefuseProjectiveTransforms) {
  const Error error = importError(
      "a.glb",
      glbWithNodes(
          R"([{"children":[1]},{"mesh":0,"name":"lens","matrix":[1,0,0,0.5,0,1,0,0,0,0,1,0,0,0,0,1]}])"));
  EXPECT_THAT(error.message, StartsWith("node 'lens' has a projective transform"));
}

TEST(MeshErrors, RefuseAColladaUnitThatIsNoLengthUnlessOverridden) {
  for (const char* meter : {"0", "-1", "nan"}) {
    const std::string file = daeFile(unevenBox(), {"Y_UP", meter, ""});
    const Error error = importError("box.dae", file);
    EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
    EXPECT_THAT(error.message, StartsWith("the meters of its <unit> are not a positive number"));
    EXPECT_TRUE(
        importContent("box.dae", file, {.up = bake::UpAxis::kY, .scale = 1.0, .transform = {}})
            .has_value());
  }
}

TEST(MeshErrors, NameTheMissingBufferOfAGltf) {
  const Error error = importError(
      "box.gltf",
      gltfFile(unevenBox(),
               {.nodes = GltfPieces{}.nodes, .buffer_uri = R"("uri":"absent.bin",)", .more = {}}));
  EXPECT_EQ(error.code, ErrorCode::kInvalidInput);
  EXPECT_THAT(error.message, HasSubstr("absent.bin"));
}

TEST(MeshErrors, NameTheGltfExtensionThatIsNotSupported) {
  for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
    const std::string more =
        fmt::format(R"(,"extensionsUsed":["{0}"],"extensionsRequired":["{0}"])", extension);
    const GltfPieces pieces{.nodes = GltfPieces{}.nodes, .buffer_uri = {}, .more = more};
    for (const char* name : {"box.glb", "BOX.GLB"}) {
      const Error error = importError(name, glbFile(unevenBox(), pieces));
      EXPECT_EQ(error.code, ErrorCode::kUnsupported);
      EXPECT_EQ(error.message,
                fmt::format("it requires the glTF extension {}, which is not supported; export it "
                            "without that extension (uncompressed)",
                            extension));
    }
  }
}

TEST(MeshErrors, AcceptGltfExtensionsThatChangeOnlyAppearanceOrAreOptional) {
  for (const char* more :
       {R"(,"extensionsUsed":["KHR_materials_unlit"],"extensionsRequired":["KHR_materials_unlit"])",
        R"(,"extensionsUsed":["KHR_draco_mesh_compression"])",
        R"(,"extras":{"extensionsRequired":["KHR_draco_mesh_compression"]})"}) {
    EXPECT_TRUE(importContent("box.glb", glbFile(unevenBox(), {.nodes = GltfPieces{}.nodes,
                                                               .buffer_uri = {},
                                                               .more = more}))
                    .has_value())
        << more;
  }
}

TEST(MeshErrors, WarnOfGltfGeometryThatStandsElsewhere) {
  const auto warningsOf = [](const char* more) {
    const auto asset = importContent(
        "box.glb",
        glbFile(unevenBox(), {.nodes = GltfPieces{}.nodes, .buffer_uri = {}, .more = more}));
    EXPECT_TRUE(asset) << more;
    return asset ? asset->warnings : std::vector<std::string>{};
  };
  EXPECT_THAT(warningsOf(R"(,"extensionsUsed":["EXT_mesh_gpu_instancing"])"),
              testing::ElementsAre(HasSubstr("instances of EXT_mesh_gpu_instancing are not read")));
  EXPECT_THAT(warningsOf(R"(,"skins":[{"joints":[0]}])"),
              testing::ElementsAre(HasSubstr("skeletons are not read")));
  EXPECT_THAT(warningsOf(R"(,"extras":{"skins":1,"extensionsUsed":["EXT_mesh_gpu_instancing"]})"),
              testing::IsEmpty());
}

TEST(MeshErrors, RefuseScalesAndTransformsThatAreNone) {
  const std::string box = objFile(unevenBox());
  for (const double scale : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity()}) {
    const Error error = importError("box.obj", box, {.up = {}, .scale = scale, .transform = {}});
    EXPECT_EQ(error.where, "scale");
    EXPECT_THAT(error.message,
                EndsWith("is out of range; give a positive number of meters per unit"));
  }
  const Error error =
      importError("box.obj", box, {.up = {}, .scale = {}, .transform = bake::Affine{}});
  EXPECT_EQ(error.where, "transform");
}

}  // namespace
}  // namespace galactic::test::errors_test
