// Marks of several layers: flux, units, or both.
#include <gtest/gtest.h>

#include "engine/attack/attack.h"
#include "engine/attack/stored_mesh.h"
#include "engine/base/error.h"
#include "engine/geometry/box.h"
#include "engine/io/export_mesh.h"
#include "engine/marking/extract.h"
#include "engine/marking/mark.h"
#include "engine/marking/mark_file.h"
#include "engine/marking/read_file.h"
#include "engine/marking/refusal.h"
#include "engine/marking/verify_file.h"
#include "engine/metric/deformation.h"
#include "engine/metric/structural_distortion.h"
#include "manifests/record.h"
#include "tests/flux/flux_shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

MarkRequest request_for(const std::string& scheme, const std::string& message = "leak 4711") {
  return resolve({{"scheme", scheme}, {"message", message}});
}

Marking marked(const Mesh& mesh, const MarkRequest& request) {
  const Halfedges halfedges = build_halfedges(mesh);
  return mark({mesh, halfedges}, request.payload, Key::trial(), request.options, as_float, 0);
}

Extraction read(const Mesh& mesh, const Encoding& encoding) {
  const Halfedges halfedges = build_halfedges(mesh);
  return extract({mesh, halfedges}, encoding, Key::trial());
}

const Mesh& shape() {
  static const Mesh mesh = test::knobbly(60);
  return mesh;
}

const Encoding kFlux{std::string(kFluxScheme), {}, {}};

TEST(Layers, AreNamedByTheirScheme) {
  for (const char* name : {"auto", "flux", "tsq", "iie", "flux+tsq", "flux+aie"}) {
    EXPECT_EQ(default_mark_options(name, false).scheme_name(), name);
    EXPECT_EQ(std::get<std::string>(values_of(default_mark_options(name, false)).at("scheme")),
              name);
  }
  EXPECT_EQ(request_for("flux").options.units, LayerUse::No);
  EXPECT_THROW((void)resolve({{"scheme", "flux+xyz"}, {"message", "a"}}), Error);
  EXPECT_THROW((void)resolve({{"scheme", "flux"}, {"fill", true}}), Error);
}

TEST(Layers, AreEachReadByThemselves) {
  const MarkRequest request = request_for("flux+tsq");
  const Marking marking = marked(shape(), request);
  ASSERT_EQ(marking.status, MarkStatus::Marked);
  ASSERT_TRUE(marking.flux);
  const Mesh mesh{marking.positions, shape().triangles};
  EXPECT_EQ(read(mesh, request.options.encoding()).message, request.message());
  const Extraction flux = read(mesh, kFlux);
  ASSERT_TRUE(flux.flux);
  EXPECT_TRUE(stands_for(flux.flux->payload, request.message(), Key::trial()));
}

TEST(Layers, AnswerWhereTheOtherIsLost) {
  const MarkRequest request = request_for("auto");
  const Marking marking = marked(shape(), request);
  const Mesh mesh{marking.positions, shape().triangles};
  const Mesh smooth = stored(Attack::parsed("smooth:10").applied(mesh, 1));
  EXPECT_TRUE(read(smooth, kFlux).flux);
  EXPECT_FALSE(read(smooth, request.options.encoding()).message);
  const Mesh cropped = stored(Attack::parsed("crop:50").applied(mesh, 1));
  EXPECT_FALSE(read(cropped, kFlux).flux);
  EXPECT_EQ(read(cropped, request.options.encoding()).message, request.message());
}

TEST(Layers, OfAutoAreThoseThatTheMeshCanCarry) {
  // a ball has no axes
  const Marking ball = marked(test::sphere(60, 1), request_for("auto"));
  EXPECT_EQ(ball.status, MarkStatus::Marked);
  EXPECT_FALSE(ball.flux);
  EXPECT_EQ(ball.flux_obstacle, FluxObstacle::NoAxes);
  // a shape with too few units for so long a message
  const Marking small = marked(test::knobbly(26), request_for("auto", std::string(256, 'm')));
  EXPECT_EQ(small.status, MarkStatus::Marked);
  EXPECT_TRUE(small.flux);
  EXPECT_TRUE(small.words.empty());
}

TEST(Layers, OfFluxAloneAreRefusedWithAReason) {
  const MarkRequest request = request_for("flux");
  const Marking ball = marked(test::sphere(60, 1), request);
  EXPECT_EQ(ball.status, MarkStatus::NoFlux);
  EXPECT_NE(refusal(ball, request, 0).find("axes"), std::string::npos);
}

TEST(Layers, AreRecognisedBeforeASecondMark) {
  const MarkRequest request = request_for("flux");
  const Marking first = marked(shape(), request);
  const Mesh mesh{first.positions, shape().triangles};
  const Marking second = marked(mesh, request);
  EXPECT_EQ(second.status, MarkStatus::AlreadyMarked);
  EXPECT_NE(refusal(second, request, 0).find("number"), std::string::npos);
}

// The limit of moves is for the sum of the layers.
TEST(Layers, TogetherKeepWithinTheLimitOfMoves) {
  const double diagonal = box_diagonal(shape().positions);
  for (const char* scheme : {"auto", "flux+tsq", "flux"}) {
    const MarkRequest request =
        resolve({{"scheme", scheme}, {"message", "leak 4711"}, {"max_move", 0.3}});
    const Marking marking = marked(shape(), request);
    ASSERT_EQ(marking.status, MarkStatus::Marked) << scheme;
    EXPECT_TRUE(marking.flux) << scheme;
    const Displacement moves = displacement(shape().positions, marking.positions);
    EXPECT_LE(100 * moves.max / diagonal, 0.3) << scheme;
    EXPECT_GT(moves.max, 0) << scheme;
  }
}

TEST(Layers, StrengthMovesTheSurfaceMore) {
  double last = 0;
  for (const char* strength : {"light", "normal", "strong"}) {
    const MarkRequest request =
        resolve({{"scheme", "flux"}, {"message", "leak 4711"}, {"strength", strength}});
    const Marking marking = marked(shape(), request);
    ASSERT_TRUE(marking.flux) << strength;
    EXPECT_GT(marking.flux->rms_percent, 1.2 * last) << strength;
    last = marking.flux->rms_percent;
  }
}

// What each layer may lack is made up for: the mark of both exceeds the budget of neither.
TEST(Layers, KeepWithinTheVisibilityAskedFor) {
  const Mesh& mesh = shape();
  for (const char* scheme : {"auto", "flux+tsq", "tsq", "aie"}) {
    const MarkRequest free = resolve({{"scheme", scheme}, {"message", "leak 4711"}});
    const double seen = msdm2(mesh, {marked(mesh, free).positions, mesh.triangles});
    const MarkRequest limited =
        resolve({{"scheme", scheme}, {"message", "leak 4711"}, {"max_visibility", 0.7 * seen}});
    const Marking marking = marked(mesh, limited);
    ASSERT_EQ(marking.status, MarkStatus::Marked) << scheme << refusal(marking, limited, 0);
    const double visibility = msdm2(mesh, {marking.positions, mesh.triangles});
    EXPECT_LE(visibility, 0.7 * seen * 1.0001) << scheme;
    EXPECT_GT(visibility, 0) << scheme;
  }
}

TEST(Layers, AreRefusedWhereNoMarkKeepsWithinTheVisibility) {
  const MarkRequest request =
      resolve({{"scheme", "tsq"}, {"message", "leak 4711"}, {"max_visibility", 1e-6}});
  const Marking marking = marked(shape(), request);
  EXPECT_EQ(marking.status, MarkStatus::TooVisible);
  EXPECT_NE(refusal(marking, request, 0).find("--max-visibility"), std::string::npos);
}

TEST(Layers, OfALightMarkAreNotSeen) {
  const MarkRequest request =
      resolve({{"scheme", "auto"}, {"message", "leak 4711"}, {"strength", "light"}});
  const Marking marking = marked(shape(), request);
  ASSERT_EQ(marking.status, MarkStatus::Marked);
  EXPECT_LE(msdm2(shape(), {marking.positions, shape().triangles}), 0.05);
}

TEST(Layers, OfAFileAreWrittenReadBackRecordedAndVerified) {
  const test::TempFolder folder;
  const auto write = [&](const Mesh& mesh, const std::string& name) {
    const std::vector<char> bytes = export_mesh(mesh, {.format = FileFormat::Obj});
    folder.write(name, {bytes.data(), bytes.size()});
  };
  write(stored(shape()), "in.obj");
  const MarkedFile file =
      mark_file(folder / "in.obj", folder / "out.obj", request_for("auto"), Key::trial());
  ASSERT_TRUE(file.is_marked()) << file.error;
  ASSERT_TRUE(file.flux);
  EXPECT_GT(file.parts, 0U);
  Record record{.file = file};
  const MarkedFile parsed = parse_record(line_of(record)).file;
  EXPECT_EQ(parsed.flux->payload, file.flux->payload);
  EXPECT_EQ(parsed.request.options, file.request.options);
  EXPECT_EQ(verify_file(parsed, Key::trial()).verdict, FileVerdict::Intact);

  const Mesh mesh = MeshFile::open(folder / "out.obj").mesh();
  write(stored(Attack::parsed("smooth:5").applied(mesh, 1)), "out.obj");
  const Verification altered = verify_file(parsed, Key::trial());
  EXPECT_EQ(altered.verdict, FileVerdict::Altered);
  EXPECT_NE(altered.detail.find("flux layer"), std::string::npos) << altered.detail;
  const FileReading reading =
      read_file(folder / "out.obj", encodings_of({}), std::vector<Key>{Key::trial()});
  ASSERT_TRUE(reading.mark);
  EXPECT_EQ(reading.mark->encoding.scheme, kFluxScheme);
  EXPECT_EQ(reading.mark->flux->payload, file.flux->payload);

  write(stored(shape()), "out.obj");
  EXPECT_EQ(verify_file(parsed, Key::trial()).verdict, FileVerdict::Lost);
}

}  // namespace
}  // namespace triglyph
