#pragma once
#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace galactic::test {

/// Vertices and triangles to be written as a mesh file, in the file's own frame and unit.
struct MeshContent {
  std::vector<std::array<float, 3>> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// A box whose three edges differ (1 x 2 x 3 units) and whose corner lies off the origin, so that
/// every mix-up of axes or signs shows. Counter-clockwise from outside.
inline MeshContent unevenBox() {
  MeshContent box;
  for (unsigned corner = 0; corner < 8; ++corner) {
    box.positions.push_back({(corner & 1U) != 0 ? 1.5F : 0.5F, (corner & 2U) != 0 ? 2.25F : 0.25F,
                             (corner & 4U) != 0 ? 4.F : 1.F});
  }
  box.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return box;
}

/// The bytes of `value`, little-endian as on every machine we run on.
template <class T>
std::string bytesOf(const T& value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

inline std::string objFile(const MeshContent& mesh, std::string_view head = "") {
  std::string file(head);
  for (const auto& p : mesh.positions) file += fmt::format("v {} {} {}\n", p[0], p[1], p[2]);
  for (const auto& t : mesh.triangles) {
    file += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  }
  return file;
}

inline std::string plyHeader(const MeshContent& mesh, std::string_view format) {
  return fmt::format(
      "ply\nformat {} 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float "
      "z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      format, mesh.positions.size(), mesh.triangles.size());
}

inline std::string plyAsciiFile(const MeshContent& mesh) {
  std::string file = plyHeader(mesh, "ascii");
  for (const auto& p : mesh.positions) file += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
  for (const auto& t : mesh.triangles) file += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return file;
}

inline std::string plyBinaryFile(const MeshContent& mesh) {
  std::string file = plyHeader(mesh, "binary_little_endian");
  for (const auto& p : mesh.positions) file += bytesOf(p);
  for (const auto& t : mesh.triangles) file += '\3' + bytesOf(t);
  return file;
}

inline std::string offFile(const MeshContent& mesh) {
  std::string file = fmt::format("OFF\n{} {} 0\n", mesh.positions.size(), mesh.triangles.size());
  for (const auto& p : mesh.positions) file += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
  for (const auto& t : mesh.triangles) file += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
  return file;
}

inline std::string stlAsciiFile(const MeshContent& mesh) {
  std::string file = "solid box\n";
  for (const auto& t : mesh.triangles) {
    file += "facet normal 0 0 0\nouter loop\n";
    for (const std::uint32_t corner : t) {
      const auto& p = mesh.positions[corner];
      file += fmt::format("vertex {} {} {}\n", p[0], p[1], p[2]);
    }
    file += "endloop\nendfacet\n";
  }
  return file + "endsolid box\n";
}

inline std::string stlBinaryFile(const MeshContent& mesh) {
  std::string file(80, ' ');
  file += bytesOf(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    file += std::string(12, '\0');
    for (const std::uint32_t corner : t) file += bytesOf(mesh.positions[corner]);
    file += std::string(2, '\0');
  }
  return file;
}

/// The buffer that glTF files of `mesh` refer to: indices, then positions.
inline std::string gltfBuffer(const MeshContent& mesh) {
  std::string buffer;
  for (const auto& t : mesh.triangles) buffer += bytesOf(t);
  for (const auto& p : mesh.positions) buffer += bytesOf(p);
  return buffer;
}

/// What varies between the glTF files of the tests; every text is a piece of JSON.
struct GltfPieces {
  /// The nodes array; node 0 is the scene's root. All of them may place mesh 0.
  std::string nodes = R"([{"mesh":0,"name":"box"}])";
  /// "uri" of the buffer with a comma after it, or nothing for the binary chunk of a GLB.
  std::string buffer_uri;
  /// Further top-level members, each with a comma before it.
  std::string more;
};

inline std::string gltfFile(const MeshContent& mesh, const GltfPieces& pieces = {}) {
  std::array<float, 3> low = mesh.positions.front();
  std::array<float, 3> high = low;
  for (const auto& p : mesh.positions) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  const std::size_t index_bytes = 12 * mesh.triangles.size();
  const std::size_t position_bytes = 12 * mesh.positions.size();
  return fmt::format(
      R"({{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0]}}],"nodes":{},)"
      R"("meshes":[{{"name":"box mesh","primitives":[{{"attributes":{{"POSITION":1}},"indices":0}}]}}],)"
      R"("accessors":[{{"bufferView":0,"componentType":5125,"count":{},"type":"SCALAR"}},)"
      R"({{"bufferView":1,"componentType":5126,"count":{},"type":"VEC3","min":[{},{},{}],"max":[{},{},{}]}}],)"
      R"("bufferViews":[{{"buffer":0,"byteLength":{}}},{{"buffer":0,"byteOffset":{},"byteLength":{}}}],)"
      R"("buffers":[{{{}"byteLength":{}}}]{}}})",
      pieces.nodes, 3 * mesh.triangles.size(), mesh.positions.size(), low[0], low[1], low[2],
      high[0], high[1], high[2], index_bytes, index_bytes, position_bytes, pieces.buffer_uri,
      index_bytes + position_bytes, pieces.more);
}

/// A GLB of this JSON and binary chunk.
inline std::string glbContainer(std::string json, std::string binary) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  binary.resize((binary.size() + 3) / 4 * 4, '\0');
  const auto word = [](std::size_t value) { return bytesOf(static_cast<std::uint32_t>(value)); };
  return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + binary.size()) + word(json.size()) +
         "JSON" + json + word(binary.size()) + std::string("BIN\0", 4) + binary;
}

inline std::string glbFile(const MeshContent& mesh, const GltfPieces& pieces = {}) {
  return glbContainer(gltfFile(mesh, pieces), gltfBuffer(mesh));
}

/// What varies between the COLLADA files of the tests.
struct DaePieces {
  /// "X_UP" and so on; empty leaves the element out.
  std::string up_axis;
  /// Text of the meter attribute; empty leaves the element out.
  std::string meter;
  /// Transform elements of the only node.
  std::string transform;
};

inline std::string daeFile(const MeshContent& mesh, const DaePieces& pieces) {
  std::string numbers;
  for (const auto& p : mesh.positions) numbers += fmt::format("{} {} {} ", p[0], p[1], p[2]);
  std::string indices;
  for (const auto& t : mesh.triangles) indices += fmt::format("{} {} {} ", t[0], t[1], t[2]);
  const std::string unit =
      pieces.meter.empty() ? "" : fmt::format(R"(<unit name="u" meter="{}"/>)", pieces.meter);
  const std::string up =
      pieces.up_axis.empty() ? "" : fmt::format("<up_axis>{}</up_axis>", pieces.up_axis);
  return fmt::format(
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" )"
      R"(version="1.4.1"><asset>{}{}</asset><library_geometries><geometry id="g" name="box">)"
      R"(<mesh><source id="p"><float_array id="a" count="{}">{}</float_array><technique_common>)"
      R"(<accessor source="#a" count="{}" stride="3"><param name="X" type="float"/>)"
      R"(<param name="Y" type="float"/><param name="Z" type="float"/></accessor>)"
      R"(</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/>)"
      R"(</vertices><triangles count="{}"><input semantic="VERTEX" source="#v" offset="0"/>)"
      R"(<p>{}</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>)"
      R"(<visual_scene id="s" name="s"><node id="n" name="n">{}<instance_geometry url="#g"/>)"
      R"(</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/>)"
      R"(</scene></COLLADA>)",
      unit, up, 3 * mesh.positions.size(), numbers, mesh.positions.size(), mesh.triangles.size(),
      indices, pieces.transform);
}

/// A minimal ASCII FBX with the given global settings; `unit` is in centimeters.
struct FbxPieces {
  int up_axis = 1;
  int up_sign = 1;
  double unit = 100;
};

inline std::string fbxFile(const MeshContent& mesh, const FbxPieces& pieces) {
  std::string numbers;
  for (const auto& p : mesh.positions) {
    numbers += fmt::format("{}{},{},{}", numbers.empty() ? "" : ",", p[0], p[1], p[2]);
  }
  std::string indices;
  for (const auto& t : mesh.triangles) {
    // The last corner of a polygon is stored as its complement.
    indices += fmt::format("{}{},{},-{}", indices.empty() ? "" : ",", t[0], t[1], t[2] + 1);
  }
  return fmt::format(
      "; FBX 7.4.0 project file\n"
      "FBXHeaderExtension:  {{\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}}\n"
      "GlobalSettings:  {{\n\tVersion: 1000\n\tProperties70:  {{\n"
      "\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\",{}\n"
      "\t\tP: \"UpAxisSign\", \"int\", \"Integer\", \"\",{}\n"
      "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\",{}\n\t}}\n}}\n"
      "Objects:  {{\n\tGeometry: 1000, \"Geometry::box\", \"Mesh\" {{\n"
      "\t\tVertices: *{} {{\n\t\t\ta: {}\n\t\t}}\n"
      "\t\tPolygonVertexIndex: *{} {{\n\t\t\ta: {}\n\t\t}}\n\t\tGeometryVersion: 124\n\t}}\n"
      "\tModel: 2000, \"Model::box\", \"Mesh\" {{\n\t\tVersion: 232\n\t}}\n}}\n"
      "Connections:  {{\n\tC: \"OO\",2000,0\n\tC: \"OO\",1000,2000\n}}\n",
      pieces.up_axis, pieces.up_sign, pieces.unit, 3 * mesh.positions.size(), numbers,
      3 * mesh.triangles.size(), indices);
}

}  // namespace galactic::test
