// Times whole processes in pairs: `triglyph mark` on a mesh against a program that only opens and
// saves it with OpenMesh, and `triglyph --version`. Prints medians and the median ratio.
//   compare_processes MESH [RUNS]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

// Wall time of one run, seconds; ends the program if the command fails.
double time_of(const std::vector<std::string>& command) {
  std::vector<char*> arguments;
  for (const std::string& word : command) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const auto start = std::chrono::steady_clock::now();
  const pid_t child = fork();
  if (child == 0) {
    const int null = open("/dev/null", O_WRONLY);
    dup2(null, STDOUT_FILENO);
    dup2(null, STDERR_FILENO);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  const auto elapsed = std::chrono::steady_clock::now() - start;
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    std::fprintf(stderr, "%s failed\n", command[0].c_str());
    std::exit(1);
  }
  return std::chrono::duration<double>(elapsed).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: compare_processes MESH [RUNS]\n");
    return 2;
  }
  const std::string mesh = argv[1];
  const int runs = argc > 2 ? std::atoi(argv[2]) : 21;
  std::string folder = (std::filesystem::temp_directory_path() / "triglyph-XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr || runs < 1) return 1;

  const std::string plain = folder + "/plain" + std::filesystem::path(mesh).extension().string();
  const std::vector<std::string> mark{TRIGLYPH_EXECUTABLE, "mark", mesh, "--out", folder + "/out"};
  const std::vector<std::string> rewrite{OPENMESH_REWRITE, mesh, plain};
  std::vector<double> mark_s, rewrite_s, ratio, version_s;
  for (int run = -1; run < runs; ++run) {  // the first pair warms the caches and is not counted
    const double a = time_of(mark);
    const double b = time_of(rewrite);
    const double c = time_of({TRIGLYPH_EXECUTABLE, "--version"});
    if (run < 0) continue;
    mark_s.push_back(a);
    rewrite_s.push_back(b);
    ratio.push_back(a / b);
    version_s.push_back(c);
  }
  std::printf("triglyph mark            %7.1f ms\n", 1e3 * median(mark_s));
  std::printf("OpenMesh open and save   %7.1f ms\n", 1e3 * median(rewrite_s));
  std::printf("ratio, pair by pair      %7.2f\n", median(ratio));
  std::printf("triglyph --version       %7.1f ms\n", 1e3 * median(version_s));
  std::filesystem::remove_all(folder);
  return 0;
}
