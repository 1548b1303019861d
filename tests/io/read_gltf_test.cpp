#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>

#include "engine/io/export_mesh.h"
#include "engine/io/gltf.h"
#include "engine/samples/sample_shapes.h"
#include "tests/io/mesh_text.h"
#include "tests/io/random_gltf.h"
#include "tests/support/temp_folder.h"

namespace triglyph::test {
namespace {

using Json = nlohmann::ordered_json;

const char* name_of_kind(bool is_binary) {
  return is_binary ? "a.glb" : "a.gltf";
}

void expect_mesh(const MeshFile& file, const RandomGltf& made, const std::string& data) {
  ASSERT_EQ(file.vertex_count(), made.places.size());
  for (std::size_t v = 0; v < made.places.size(); ++v) {
    const Vec3& p = file.mesh().positions[file.point_of_vertex()[v]];
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(p[axis],
                stored_in(data, made.places[v], static_cast<std::size_t>(axis), made.component));
    }
  }
  std::vector<Triangle> triangles;
  for (const auto& face : made.faces) {
    const Triangle t = {file.point_of_vertex()[face[0]], file.point_of_vertex()[face[1]],
                        file.point_of_vertex()[face[2]]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  ASSERT_EQ(file.mesh().triangles, triangles);
}

// Everything but positions and their bounds is as before, and the bounds are those of the
// positions.
void expect_moved(const RandomGltf& made, const GltfParts& after, const MeshFile& file,
                  const std::vector<Vec3>& positions) {
  std::string data = made.data;
  for (std::size_t v = 0; v < made.places.size(); ++v) {
    const Vec3& to = positions[file.point_of_vertex()[v]];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double old = stored_in(made.data, made.places[v], axis, made.component);
      const double now = stored_in(after.data, made.places[v], axis, made.component);
      const int a = static_cast<int>(axis);
      ASSERT_EQ(now, to[a] == old ? old : file.round(to)[a]);
      const std::size_t at = made.places[v] + axis * made.component;
      data.replace(at, made.component, after.data, at, made.component);
    }
  }
  ASSERT_EQ(data, after.data);
  Json json = after.json;
  for (std::size_t i = 0; i < json["accessors"].size(); ++i) {
    if (!json["accessors"][i].contains("min")) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (std::size_t v = 0; v < made.places.size(); ++v) {
        if (made.accessor[v] != i) continue;
        const double value = stored_in(after.data, made.places[v], axis, made.component);
        least = std::min(least, value);
        most = std::max(most, value);
      }
      ASSERT_EQ(json["accessors"][i]["min"][axis].get<double>(), least);
      ASSERT_EQ(json["accessors"][i]["max"][axis].get<double>(), most);
    }
    json["accessors"][i]["min"] = made.json["accessors"][i]["min"];
    json["accessors"][i]["max"] = made.json["accessors"][i]["max"];
  }
  if (!made.is_binary) json["buffers"][0]["uri"] = made.json["buffers"][0]["uri"];
  ASSERT_EQ(json.dump(), made.json.dump());
  ASSERT_EQ(after.rest, made.is_binary ? "any!" : "");
}

TEST(ReadGltf, IsPatchedInPositionsAndTheirBoundsAlone) {
  const char* asked = std::getenv("TRIGLYPH_FILES");  // as in patch_property_test.cpp
  const std::uint64_t files = asked == nullptr ? 1500 : std::strtoull(asked, nullptr, 10);
  for (std::uint64_t seed = 0; seed < files; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const RandomGltf made = random_gltf(seed, seed % 3 != 0);
    const char* name = name_of_kind(made.is_binary);
    const MeshFile file = read_text(made.bytes, name);
    ASSERT_EQ(file.why_fixed(), "");
    ASSERT_NO_FATAL_FAILURE(expect_mesh(file, made, made.data)) << made.bytes;
    ASSERT_EQ(moved(file, {0, 0, 0}), made.bytes);
    std::mt19937_64 random(seed);
    std::vector<Vec3> positions = file.mesh().positions;
    for (Vec3& p : positions) {
      if (random() % 2 == 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        p[axis] += (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5) *
                   (made.component == 4 ? 0.25 : 5);
      }
    }
    const std::vector<char> patched = file.patched(positions);
    const std::string text(patched.begin(), patched.end());
    const GltfParts after = parts_of_gltf(text, made.is_binary);
    ASSERT_NO_FATAL_FAILURE(expect_moved(made, after, file, positions)) << text;
    ASSERT_NO_FATAL_FAILURE(expect_mesh(read_text(text, name), made, after.data));
  }
}

TEST(ReadGltf, ReadsWhatIsExported) {
  const Mesh mesh = make_sample_shape(SampleShape::Closed, 500, 3);
  for (const FileFormat format : {FileFormat::Glb, FileFormat::Gltf}) {
    const std::vector<char> bytes = export_mesh(mesh, {.format = format});
    const MeshFile file = MeshFile::read(bytes, name_of_kind(format == FileFormat::Glb));
    EXPECT_EQ(file.format(), format);
    EXPECT_EQ(file.mesh().triangles, mesh.triangles);
    for (std::size_t p = 0; p < mesh.positions.size(); ++p) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_EQ(file.mesh().positions[p][axis],
                  static_cast<double>(static_cast<float>(mesh.positions[p][axis])));
      }
    }
  }
}

// A triangle whose JSON the tests change.
Json triangle_json() {
  return Json::parse(R"({"asset":{"version":"2.0"},
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "accessors":[
      {"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
      {"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":6}],
    "buffers":[{"byteLength":44}]})");
}

std::string triangle_data() {
  const float points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint16_t corners[4] = {0, 1, 2, 0};
  std::string data(reinterpret_cast<const char*>(points), sizeof points);
  return data.append(reinterpret_cast<const char*>(corners), sizeof corners);
}

std::string outcome_of(const Json& json) {
  return outcome(glb_of(json.dump(), triangle_data()), "a.glb");
}

TEST(ReadGltf, RefusesWhatIsWrongAtItsPlace) {
  EXPECT_EQ(outcome_of(triangle_json()), "read");
  const std::tuple<const char*, Json, const char*> changes[] = {
      {"/asset/version", "1.0", "unsupported "},
      {"/accessors/0/count", 4, "malformed accessors[0]"},
      {"/accessors/0/count", -1, "malformed accessors[0]"},
      {"/accessors/0/count", 9007199254740992, "malformed accessors[0]"},
      {"/accessors/0/byteOffset", 9007199254740992, "malformed accessors[0]"},
      {"/accessors/0/type", "VEC2", "malformed accessors[0]"},
      {"/accessors/0/componentType", 5125, "malformed accessors[0]"},
      {"/accessors/0/componentType", 7, "malformed accessors[0]"},
      {"/accessors/1/count", 4, "malformed accessors[1]"},
      {"/accessors/1/componentType", 5122, "malformed accessors[1]"},
      {"/bufferViews/0/byteLength", 100, "malformed bufferViews[0]"},
      {"/bufferViews/0/byteStride", 8, "malformed accessors[0]"},
      {"/bufferViews/0/buffer", 3, "malformed "},
      {"/buffers/0/byteLength", 50, "malformed buffers[0]"},
      {"/buffers/0/uri", "../../etc/passwd", "unsupported buffers[0]"},
      {"/buffers/0/uri", "/etc/passwd", "unsupported buffers[0]"},
      {"/buffers/0/uri", "a/%2e%2e/%2e%2e/passwd", "unsupported buffers[0]"},
      {"/buffers/0/uri", "file:///etc/passwd", "unsupported buffers[0]"},
      {"/buffers/0/uri", "data:text/plain,abc", "unsupported buffers[0]"},
      {"/buffers/0/uri", "data:x;base64,A?==", "malformed buffers[0]"},
      {"/buffers/0/uri", "data:x;base64,AAAA\xC5\xBE" + std::string(58, 'A'),
       "malformed buffers[0]"},
      {"/meshes/0/primitives/0/mode", 9, "malformed meshes[0].primitives[0]"},
      {"/meshes/0/primitives/0/attributes/POSITION", 5, "malformed "},
      {"/meshes/0/primitives/0/attributes", 5, "malformed meshes[0].primitives[0]"},
      {"/meshes", Json::array(), "malformed "},
  };
  for (const auto& [place, value, expected] : changes) {
    Json json = triangle_json();
    json[Json::json_pointer(place)] = value;
    EXPECT_EQ(outcome_of(json), expected) << place << " " << value;
  }
}

// Bounds that are no numbers are nobody's bounds, and stay.
TEST(ReadGltf, PassesOverBoundsOfAnotherKind) {
  Json json = triangle_json();
  json["accessors"][0]["min"] = "low";
  json["accessors"][0].erase("max");
  const std::string text =
      moved(read_text(glb_of(json.dump(), triangle_data()), "a.glb"), {1, 2, 3});
  EXPECT_EQ(parts_of_gltf(text, true).json, json);
  EXPECT_EQ(read_text(text, "a.glb").mesh().positions[0], Vec3(1, 2, 3));
}

// JSON may write characters in several ways; those of a data URI that stay are written as before.
TEST(ReadGltf, KeepsTheEscapesOfADataUri) {
  Json json = triangle_json();
  std::string data = triangle_data();
  data += "\xff\xff\xff\xff";  // slashes in base64
  json["buffers"][0]["byteLength"] = data.size();
  json["buffers"][0]["uri"] =
      "data:application\\/"
      "octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAABAAIA"
      "AAD\\/\\u002f\\/\\/\\/";
  std::string text = json.dump();
  while (text.find("\\\\") != std::string::npos) text.replace(text.find("\\\\"), 2, "\\");
  const MeshFile file = read_text(text, "a.gltf");
  EXPECT_EQ(moved(file, {0, 0, 0}), text);
  const std::string out = moved(file, {0, 0, 1});
  EXPECT_NE(out.find("application\\/octet"), std::string::npos);
  EXPECT_EQ(read_text(out, "a.gltf").mesh().positions[1], Vec3(1, 0, 1));
}

TEST(ReadGltf, RefusesBrokenContainers) {
  const std::string good = glb_of(triangle_json().dump(), triangle_data());
  for (std::size_t size = 1; size < good.size(); size += 7) {
    EXPECT_NE(outcome(good.substr(0, size), "a.glb"), "read") << size;
  }
  std::string old = good;
  old[4] = 1;
  EXPECT_EQ(outcome(old, "a.glb"), "unsupported byte 4");
  EXPECT_EQ(outcome("{\"asset\":{\"version\":\"2.0\"", "a.gltf"), "malformed byte 0");
  EXPECT_EQ(outcome(std::string(100000, '['), "a.gltf"), "malformed byte 0");
  EXPECT_EQ(outcome("[]", "a.gltf"), "malformed byte 0");
  EXPECT_EQ(outcome("{}", "a.gltf"), "malformed ");
  EXPECT_EQ(read_text(good, "a.gltf").format(), FileFormat::Glb);  // the content decides
}

TEST(ReadGltf, ReadsEqualPrimitivesOnce) {
  Json json = triangle_json();
  json["meshes"].push_back(json["meshes"][0]);
  EXPECT_EQ(read_text(glb_of(json.dump(), triangle_data()), "a.glb").face_count(), 1U);
}

// Many primitives over the same bytes must not take more memory than the file warrants.
TEST(ReadGltf, RefusesToMultiplyItsBytes) {
  Json json = triangle_json();
  for (int i = 0; i < 2000; ++i) {
    json["accessors"].push_back(json["accessors"][0]);
    const std::size_t position = json["accessors"].size() - 1;
    json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", position}}}});
  }
  const MeshFile file = read_text(glb_of(json.dump(), triangle_data()), "a.glb");
  EXPECT_LE(file.vertex_count(), file.bytes().size());
}

TEST(ReadGltf, DoesNotMovePositionsThatShareTheirBytes) {
  for (const char* role : {"normal", "morph", "shifted"}) {
    Json json = triangle_json();
    Json& primitive = json["meshes"][0]["primitives"][0];
    if (std::string(role) == "morph") primitive["targets"] = {{{"POSITION", 0}}};
    if (std::string(role) == "normal") {
      json["accessors"].push_back(json["accessors"][0]);
      primitive["attributes"]["NORMAL"] = 2;
    }
    if (std::string(role) == "shifted") {
      json["accessors"].push_back(json["accessors"][0]);
      json["accessors"][2]["byteOffset"] = 4;
      json["accessors"][2]["count"] = 2;
      json["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 2}}}});
    }
    const MeshFile file = read_text(glb_of(json.dump(), triangle_data()), "a.glb");
    EXPECT_NE(file.why_fixed().find("share bytes"), std::string::npos) << role;
    EXPECT_THROW((void)file.patched(file.mesh().positions), Error) << role;
  }
}

TEST(ReadGltf, ReadsBuffersBesideItButDoesNotMoveThem) {
  const TempFolder folder;
  std::ofstream(folder / "points 1.bin", std::ios::binary) << triangle_data();
  Json json = triangle_json();
  json["buffers"][0]["uri"] = "points%201.bin";
  std::ofstream(folder / "a.gltf", std::ios::binary) << json.dump();
  const MeshFile file = MeshFile::open(folder / "a.gltf");
  EXPECT_EQ(file.mesh().triangles.size(), 1U);
  EXPECT_NE(file.why_fixed().find("points 1.bin"), std::string::npos);
}

TEST(ReadGltf, TellsGeometryFromPictures) {
  const TempFolder folder;
  const std::string pictures(100000, 'p');
  const auto glb =
      folder.write("a.glb", glb_of(triangle_json().dump(), triangle_data() + pictures));
  EXPECT_EQ(geometry_bytes_of_glb(glb), 3 * 12 + 3 * 2);
  EXPECT_FALSE(geometry_bytes_of_glb(folder.write("b.glb", "glTF")));
  EXPECT_FALSE(geometry_bytes_of_glb(folder.write("c.glb", glb_of("{}", ""))));
  EXPECT_FALSE(geometry_bytes_of_glb(folder / "none.glb"));
}

TEST(ReadGltf, ReadsMeshoptCompression) {
  const std::string data = triangle_data();
  std::string packed(meshopt_encodeVertexBufferBound(3, 12), '\0');
  packed.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(packed.data()),
                                           packed.size(), data.data(), 3, 12));
  const std::uint16_t corners[3] = {0, 1, 2};
  std::string indices(meshopt_encodeIndexBufferBound(3, 3), '\0');
  indices.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(indices.data()),
                                           indices.size(), corners, 3));
  Json json = triangle_json();
  json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                                     {"byteLength", packed.size()},
                                                                     {"byteStride", 12},
                                                                     {"count", 3},
                                                                     {"mode", "ATTRIBUTES"}};
  json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                                     {"byteOffset", packed.size()},
                                                                     {"byteLength", indices.size()},
                                                                     {"byteStride", 2},
                                                                     {"count", 3},
                                                                     {"mode", "TRIANGLES"}};
  json["buffers"][0]["byteLength"] = packed.size() + indices.size();
  const MeshFile file = read_text(glb_of(json.dump(), packed + indices), "a.glb");
  EXPECT_EQ(file.mesh().positions, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(file.mesh().triangles, (std::vector<Triangle>{{0, 1, 2}}));
  EXPECT_NE(file.why_fixed().find("meshopt"), std::string::npos);
  auto& extension = json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
  extension["count"] = 4000000000000;  // more than the bytes can hold
  EXPECT_EQ(outcome(glb_of(json.dump(), packed + indices), "a.glb"),
            "malformed bufferViews[0].extensions.EXT_meshopt_compression");
}

TEST(ReadGltf, ReadsDracoCompression) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(1);
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const float points[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  builder.SetAttributeValuesForFace(id, draco::FaceIndex(0), points[0], points[1], points[2]);
  const auto mesh = builder.Finalize();
  draco::Encoder encoder;
  draco::EncoderBuffer buffer;
  ASSERT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  std::string data(buffer.data(), buffer.size());
  Json json = triangle_json();
  json["bufferViews"] = {{{"buffer", 0}, {"byteLength", data.size()}}};
  for (Json& accessor : json["accessors"]) accessor.erase("bufferView");
  json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", 0}, {"attributes", {{"POSITION", id}}}};
  json["buffers"][0]["byteLength"] = data.size();
  const MeshFile file = read_text(glb_of(json.dump(), data), "a.glb");
  EXPECT_EQ(file.mesh().triangles.size(), 1U);
  EXPECT_EQ(file.mesh().positions.size(), 3U);
  EXPECT_NE(file.why_fixed().find("draco"), std::string::npos);
  for (std::size_t i = 0; i < data.size(); ++i) {
    std::string broken = data;
    broken[i] = static_cast<char>(broken[i] ^ 0x41);
    (void)outcome(glb_of(json.dump(), broken), "a.glb");  // read or refused
  }
  data.resize(data.size() / 2);
  json["buffers"][0]["byteLength"] = json["bufferViews"][0]["byteLength"] = data.size();
  EXPECT_EQ(outcome(glb_of(json.dump(), data), "a.glb"),
            "malformed meshes[0].primitives[0].extensions.KHR_draco_mesh_compression");
}

TEST(ReadGltf, NamesFormatsThatItCannotRead) {
  for (const char* name : {"a.fbx", "a.USDZ", "a.blend", "a.3mf"}) {
    EXPECT_EQ(outcome("x", name), "unsupported ") << name;
  }
}

}  // namespace
}  // namespace triglyph::test
