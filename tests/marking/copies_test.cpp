// Copies of one mesh for several names, and whose copy a file is.
#include "engine/marking/copies.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "engine/attack/attack.h"
#include "engine/attack/collusion.h"
#include "engine/attack/stored_mesh.h"
#include "engine/io/export_mesh.h"
#include "engine/marking/kept_shape.h"
#include "engine/marking/mark.h"
#include "engine/marking/mark_file.h"
#include "engine/marking/trace_file.h"
#include "engine/marking/verify_file.h"
#include "engine/metric/deformation.h"
#include "engine/metric/structural_distortion.h"
#include "engine/samples/sample_shapes.h"
#include "tests/flux/flux_shapes.h"
#include "tests/support/shapes.h"
#include "tests/support/temp_folder.h"

namespace triglyph {
namespace {

Message bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

MarkRequest for_name(const std::string& name, OptionValues values = {}) {
  values["recipient"] = name;
  return resolve(values);
}

const Mesh& knobs() {
  static const Mesh mesh = test::knobbly(60);
  return mesh;
}

Marking copy_of(const Mesh& mesh, const MarkRequest& request, const Key& key = Key::trial()) {
  const Halfedges halfedges = build_halfedges(mesh);
  return mark({mesh, halfedges}, request.payload, key, request.options, as_float, 0);
}

// A folder with a mesh, its copies, and the names that may have one.
class CopiesOfAFile : public testing::Test {
 protected:
  CopiesOfAFile() {
    for (int i = 0; i < 200; ++i) names_.push_back(bytes("buyer " + std::to_string(i)));
  }

  std::filesystem::path save(const Mesh& mesh, const std::string& name) const {
    const std::vector<char> file = export_mesh(mesh, {});
    return folder_.write(name, std::string(file.begin(), file.end()));
  }

  [[nodiscard]] FileTrace trace(const std::filesystem::path& path, const MarkOptions& options,
                                const Key& key = Key::trial()) const {
    SuspectGroup group;
    group.colluders = static_cast<int>(options.collusion);
    group.encodings = fingerprint_encodings(options);
    group.names = names_;
    const std::vector<Suspects> suspects = {Suspects(key, {group})};
    return trace_file(path, suspects, {});
  }

  // Expects the trace to name buyer `number` and nobody else.
  void expect_named(const FileTrace& trace, int number) const {
    ASSERT_GE(trace.names.size(), 2U);
    EXPECT_EQ(trace.names[0].name, names_[static_cast<std::size_t>(number)]);
    EXPECT_TRUE(TraceOptions{}.believes(trace.names[0])) << trace.names[0].false_alarm_log2;
    EXPECT_FALSE(TraceOptions{}.believes(trace.names[1])) << trace.names[1].false_alarm_log2;
  }

  void expect_nobody(const FileTrace& trace) const {
    for (const Traced& traced : trace.names) EXPECT_FALSE(TraceOptions{}.believes(traced));
  }

  test::TempFolder folder_;
  std::vector<Message> names_;
};

TEST_F(CopiesOfAFile, AreTracedToTheirNamesWhateverIsDoneToThem) {
  const auto mesh = save(knobs(), "in.obj");
  const MarkRequest request = for_name("buyer 42");
  const MarkedFile file = mark_file(mesh, folder_ / "out.obj", request, Key::trial());
  ASSERT_EQ(file.status, FileStatus::Traceable) << file.error;
  EXPECT_GE(file.evidence, 100);
  ASSERT_TRUE(file.flux);
  EXPECT_EQ(file.flux->payload.content, FluxContent::Fingerprint);
  expect_named(trace(file.out, request.options), 42);
  expect_nobody(trace(mesh, request.options));
  expect_nobody(trace(file.out, request.options, Key::trial(3)));
  const MeshFile written = MeshFile::open(file.out);
  for (const char* attack : {"similarity+mirror", "crop:50", "noise:0.3", "simplify:50"}) {
    const Mesh attacked = Attack::parsed(attack).applied(written.mesh(), 5);
    expect_named(trace(save(attacked, "attacked.obj"), request.options), 42);
  }
  Verification verification = verify_file(file, Key::trial());
  EXPECT_EQ(verification.verdict, FileVerdict::Intact) << verification.detail;
  MarkedFile other = file;
  other.request = for_name("buyer 43");
  EXPECT_EQ(verify_file(other, Key::trial()).verdict, FileVerdict::Lost);
  verification = verify_file(file, Key::trial(2));
  EXPECT_EQ(verification.verdict, FileVerdict::Lost);
}

TEST_F(CopiesOfAFile, OfOneMeshDoNotDependOnEachOther) {
  const auto mesh = save(knobs(), "in.obj");
  const auto shared = std::make_shared<MeshOfCopies>();
  const auto mark_copy = [&](const std::string& name, const std::string& out,
                             const std::shared_ptr<const MeshOfCopies>& copies) {
    FileMarking marking(mesh, folder_ / out, for_name(name), copies);
    marking.load();
    marking.mark(Key::trial());
    marking.write();
    marking.read_back(Key::trial());
    marking.measure();
    marking.publish();
    EXPECT_EQ(marking.result().status, FileStatus::Traceable) << marking.result().error;
    return test::read_all(folder_ / out);
  };
  const std::string ada = mark_copy("buyer 1", "a.obj", shared);
  const std::string ben = mark_copy("buyer 2", "b.obj", shared);
  EXPECT_NE(ada, ben);
  EXPECT_EQ(mark_copy("buyer 2", "c.obj", nullptr), ben);
  EXPECT_EQ(mark_copy("buyer 1", "d.obj", shared), ada);
}

TEST(Copies, DifferInTheirBitsAlone) {
  const Halfedges halfedges = build_halfedges(knobs());
  const MarkRequest request = for_name("any", {{"scheme", std::string("tsq")}});
  const Rounding round = as_float;
  const Recut recut;
  const Key key = Key::trial();
  const Surface surface{knobs(), halfedges};
  const CopyPlan plan({surface, request.payload, key, request.options, {round, 0, recut}});
  const Marking ada = plan.copy(bytes("Ada")), ben = plan.copy(bytes("Ben"));
  ASSERT_EQ(ada.status, MarkStatus::Marked);
  std::size_t shared = 0, same_bits = 0;
  for (const Carrier& carrier : ada.carriers) {
    if (std::find(ben.carriers.begin(), ben.carriers.end(), carrier) == ben.carriers.end())
      continue;
    ++shared;
    if (ada.words[carrier.word] == ben.words[carrier.word]) ++same_bits;
    EXPECT_EQ(ada.words[carrier.word].subscript, ben.words[carrier.word].subscript);
  }
  EXPECT_GE(10 * shared, 9 * ada.carriers.size());
  EXPECT_LT(10 * same_bits, shared);
}

TEST_F(CopiesOfAFile, AreMadeOfMeshesThatAreTooSmallForAMessage) {
  const auto mesh = save(make_sample_shape(SampleShape::Closed, 180, 4), "small.obj");
  const MarkRequest whole =
      resolve({{"message", std::string("buyer 7")}, {"carry", std::string("message")}});
  EXPECT_EQ(mark_file(mesh, folder_ / "w.obj", whole, Key::trial()).status, FileStatus::TooSmall);
  const MarkRequest any = resolve({{"message", std::string("buyer 7")}});
  const MarkedFile file = mark_file(mesh, folder_ / "a.obj", any, Key::trial());
  ASSERT_EQ(file.status, FileStatus::Traceable) << file.error;
  expect_named(trace(file.out, any.options), 7);
}

TEST(Copies, AreRefusedWhereTheyWouldProveNothing) {
  const Marking of_units = copy_of(make_sample_shape(SampleShape::Closed, 80, 1),
                                   for_name("Ada", {{"scheme", std::string("tsq")}}));
  EXPECT_EQ(of_units.status, MarkStatus::TooSmall);
  const Marking of_points = copy_of(test::tetrahedron(), for_name("Ada"));
  EXPECT_EQ(of_points.status, MarkStatus::TooSmall);
  EXPECT_TRUE(of_points.needs_original);
}

TEST(Copies, KeepWithinWhatMayBeSeen) {
  const Mesh& mesh = knobs();
  const Marking usual = copy_of(mesh, for_name("Ada"));
  ASSERT_EQ(usual.status, MarkStatus::Marked);
  const Marking light = copy_of(mesh, for_name("Ada", {{"strength", std::string("light")}}));
  ASSERT_EQ(light.status, MarkStatus::Marked);
  EXPECT_LE(light.visibility, 0.05);
  EXPECT_LT(msdm2(mesh, {light.positions, mesh.triangles}, 20000),
            msdm2(mesh, {usual.positions, mesh.triangles}, 20000));
}

TEST(Copies, AreNotMadeOfAMeshThatCarriesAMessageAlready) {
  const MarkRequest first = resolve({{"message", std::string("owner")}});
  const Marking marked = copy_of(knobs(), first);
  ASSERT_EQ(marked.status, MarkStatus::Marked);
  const Mesh mesh{marked.positions, knobs().triangles};
  EXPECT_EQ(copy_of(mesh, for_name("Ada")).status, MarkStatus::AlreadyMarked);
  EXPECT_EQ(copy_of(mesh, for_name("Ada", {{"remark", true}})).status, MarkStatus::Marked);
}

TEST(Copies, TakeOptionsThatFitTogether) {
  EXPECT_THROW((void)resolve({{"message", std::string("a")}, {"collusion", std::int64_t{3}}}),
               Error);
  EXPECT_THROW((void)for_name("a", {{"part_bits", std::int64_t{16}}}), Error);
  EXPECT_THROW((void)for_name(""), Error);
  EXPECT_THROW((void)for_name(std::string(257, 'a')), Error);
  EXPECT_EQ(for_name("a").options.carry, Carry::Fingerprint);
  EXPECT_EQ(resolve({{"message", std::string("a")}}).options.carry, Carry::Any);
  EXPECT_EQ(resolve({{"message", std::string("a")}, {"scheme", std::string("tsq")}}).options.carry,
            Carry::Whole);
  EXPECT_EQ(for_name("a").options.collusion, 2U);
  const MarkOptions resistant = for_name("a", {{"collusion", std::int64_t{3}}}).options;
  EXPECT_EQ(fingerprint_encodings(resistant)[0].format.part_bits, 4);
}

TEST_F(CopiesOfAFile, AreFoundInPiecesWithTheOriginal) {
  const auto mesh = save(knobs(), "in.obj");
  const MarkRequest request = for_name("buyer 9", {{"scheme", std::string("flux")}});
  const MarkedFile file = mark_file(mesh, folder_ / "out.obj", request, Key::trial());
  ASSERT_EQ(file.status, FileStatus::Traceable) << file.error;
  const Mesh written = MeshFile::open(file.out).mesh();
  const auto piece = save(Attack::parsed("crop:40").applied(written, 5), "piece.obj");
  expect_nobody(trace(piece, request.options));
  SuspectGroup group;
  group.encodings = fingerprint_encodings(request.options);
  group.names = names_;
  group.originals = {std::make_shared<OriginalMesh>(mesh, Strength::Normal),
                     std::make_shared<OriginalMesh>(folder_ / "absent.obj", Strength::Normal)};
  const std::vector<Suspects> suspects = {Suspects(Key::trial(), {group})};
  const FileTrace found = trace_file(piece, suspects, {});
  ASSERT_FALSE(found.names.empty());
  EXPECT_EQ(found.names[0].name, names_[9]);
  EXPECT_GT(found.names[0].evidence.bits, 25);
  EXPECT_GT(found.names[0].evidence.bits, found.names[1].evidence.bits + 15);
}

class SomeShapes final : public KeptShapes {
 public:
  explicit SomeShapes(std::vector<std::vector<char>> shapes) : shapes_(std::move(shapes)) {}
  [[nodiscard]] std::size_t size() const override { return shapes_.size(); }
  [[nodiscard]] std::vector<char> bytes(std::size_t index) const override {
    return shapes_.at(index);
  }

 private:
  std::vector<std::vector<char>> shapes_;
};

// The original is not at hand, and what was kept of it stands among that of other meshes.
TEST_F(CopiesOfAFile, AreFoundInPiecesWithAShapeThatWasKept) {
  // with surroundings that tell points apart, and more triangles than a shape keeps
  Mesh mesh = Attack::parsed("simplify:50").applied(test::knobbly(130), 1);
  for (Vec3& p : mesh.positions) p[1] += 0.1 * std::sin(2 * p[1] + p[0]) + 0.05 * p[2] * p[1];
  const auto in = save(mesh, "in.obj");
  const MarkRequest request = for_name("buyer 9", {{"scheme", std::string("flux")}});
  FileMarking marking(in, folder_ / "out.obj", request);
  marking.load();
  marking.mark(Key::trial());
  marking.write();
  marking.read_back(Key::trial());
  marking.measure();
  const std::vector<char> kept = marking.kept_shape();
  marking.publish();
  ASSERT_EQ(marking.result().status, FileStatus::Traceable) << marking.result().error;
  ASSERT_FALSE(kept.empty());
  EXPECT_TRUE(marking.kept_shape().empty());
  const Mesh written = MeshFile::open(folder_ / "out.obj").mesh();
  const Halfedges halfedges = build_halfedges(knobs());
  const std::vector<char> other = KeptShape::of({knobs(), halfedges})->bytes();
  SuspectGroup group;
  group.encodings = fingerprint_encodings(request.options);
  group.names = names_;
  const auto bits_of = [&](const char* attack) {
    const auto piece = save(Attack::parsed(attack).applied(written, 5), "piece.obj");
    const std::vector<Suspects> suspects = {Suspects(Key::trial(), {group})};
    const FileTrace found = trace_file(piece, suspects, {});
    EXPECT_FALSE(found.names.empty());
    return found.names[0].name == names_[9] ? found.names[0].evidence.bits : 0;
  };
  EXPECT_LT(bits_of("crop:30"), 20);
  group.shapes = std::make_shared<SomeShapes>(std::vector<std::vector<char>>{other, {}, kept});
  EXPECT_GT(bits_of("crop:30"), 30);
  EXPECT_GT(bits_of("crop:30+similarity"), 30);
  EXPECT_GT(bits_of("crop:30+similarity+mirror"), 30);
  group.shapes = std::make_shared<SomeShapes>(std::vector<std::vector<char>>{other});
  EXPECT_LT(bits_of("crop:30"), 20);
}

TEST(KeptShape, IsReadBackAndNothingElseIs) {
  const Halfedges halfedges = build_halfedges(knobs());
  const std::optional<KeptShape> shape = KeptShape::of({knobs(), halfedges});
  ASSERT_TRUE(shape);
  EXPECT_EQ(shape->coarse.triangles.size(), knobs().triangles.size());  // there are not many
  const std::vector<char> bytes = shape->bytes();
  const std::optional<KeptShape> again = KeptShape::from_bytes(bytes);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->bytes(), bytes);
  EXPECT_EQ(again->landmarks, shape->landmarks);
  EXPECT_EQ(again->solid.values.flux, shape->solid.values.flux);
  EXPECT_EQ(again->solid.frame.axes, shape->solid.frame.axes);
  for (std::size_t size = 0; size < bytes.size(); size += 101) {
    EXPECT_FALSE(KeptShape::from_bytes({bytes.data(), size})) << size;
  }
  std::vector<char> damaged = bytes;
  for (std::size_t i = 0; i < damaged.size(); i += 37) {  // any end but a crash
    damaged[i] = static_cast<char>(damaged[i] ^ 0x55);
    (void)KeptShape::from_bytes(damaged);
    damaged[i] = bytes[i];
  }
  const Mesh flat{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 2}}};
  const Halfedges flat_halfedges = build_halfedges(flat);
  EXPECT_FALSE(KeptShape::of({flat, flat_halfedges}));
}

TEST_F(CopiesOfAFile, OfABoxNeedTheOriginalAndAreFoundHoweverItIsTurned) {
  Mesh box{{},
           {{0, 2, 1},
            {1, 2, 3},
            {4, 5, 6},
            {5, 7, 6},
            {0, 1, 4},
            {1, 5, 4},
            {2, 6, 3},
            {3, 6, 7},
            {0, 4, 2},
            {2, 4, 6},
            {1, 3, 5},
            {3, 7, 5}}};
  for (int corner = 0; corner < 8; ++corner) {
    box.positions.emplace_back(corner & 1, (corner >> 1) & 1, corner >> 2);
  }
  const auto mesh = folder_.write("box.obj", [&] {
    std::string text;  // of whole numbers
    for (const Vec3& p : box.positions) {
      text += "v " + std::to_string(std::lround(p[0])) + " " + std::to_string(std::lround(p[1])) +
              " " + std::to_string(std::lround(p[2])) + "\n";
    }
    for (const Triangle& t : box.triangles) {
      text += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " +
              std::to_string(t[2] + 1) + "\n";
    }
    return text;
  }());
  const MarkRequest request = for_name("buyer 5");
  const MarkedFile file = mark_file(mesh, folder_ / "out.obj", request, Key::trial());
  ASSERT_EQ(file.status, FileStatus::Traceable) << file.error;
  EXPECT_TRUE(file.needs_original);
  EXPECT_GT(file.digits, 1);
  EXPECT_EQ(verify_file(file, Key::trial()).verdict, FileVerdict::Intact);
  SuspectGroup group;
  group.names = names_;
  group.originals = {std::make_shared<OriginalMesh>(mesh, Strength::Normal)};
  const std::vector<Suspects> suspects = {Suspects(Key::trial(), {group})};
  const Mesh written = MeshFile::open(file.out).mesh();
  for (const char* attack : {"none", "similarity", "mirror+reorder"}) {
    const auto suspect = save(Attack::parsed(attack).applied(written, 3), "suspect.obj");
    expect_named(trace_file(suspect, suspects, {}), 5);
  }
  expect_nobody(trace_file(mesh, suspects, {}));
}

TEST(Copies, ResistMoreColludersTheMoreBitsTheyHave) {
  EXPECT_EQ(colluders_resisted(0), 1);
  int last = 1;
  for (std::size_t bits = 16; bits < 100000; bits *= 2) {
    EXPECT_GE(colluders_resisted(bits), last);
    last = colluders_resisted(bits);
  }
  EXPECT_EQ(last, kMostColluders);
  EXPECT_EQ(colluders_resisted(1024), 3);  // those of a large mesh
}

TEST_F(CopiesOfAFile, AreTracedToThoseWhoCombineThem) {
  const Mesh mesh = test::knobbly(80);
  std::vector<Mesh> copies;
  MarkOptions options;
  for (const int buyer : {3, 77, 150}) {
    const MarkRequest request = for_name("buyer " + std::to_string(buyer));
    options = request.options;
    const Marking marking = copy_of(mesh, request);
    ASSERT_EQ(marking.status, MarkStatus::Marked);
    EXPECT_GE(marking.colluders, 3);
    copies.push_back({marking.positions, mesh.triangles});
  }
  for (const CollusionKind& kind : collusion_kinds()) {
    const FileTrace found = trace(save(colluded(copies, kind.collusion, 1), "leak.obj"), options);
    ASSERT_FALSE(found.names.empty());
    // the least or the greatest by lot, coordinate by coordinate, leaves nothing of a unit's shape
    const bool is_kept = kind.collusion != Collusion::Extremes;
    EXPECT_TRUE(!is_kept || TraceOptions{}.believes(found.names[0])) << kind.name;
    for (const Traced& traced : found.names) {
      const bool is_colluder =
          traced.name == names_[3] || traced.name == names_[77] || traced.name == names_[150];
      EXPECT_TRUE(is_colluder || !TraceOptions{}.believes(traced)) << kind.name;
    }
  }
}

}  // namespace
}  // namespace triglyph
