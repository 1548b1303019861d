// fault_at CALLS NUMBER ACTION COMMAND [ARGUMENT...]: runs the command and disturbs one of its
// system calls: the one with this number, from 1, among all calls of these names, in whatever
// process or thread. CALLS is a list such as "openat,write"; those that the dynamic loader makes do
// not count. ACTION is
//   count      only prints the number of calls of each name, and of all, on standard error
//   kill       kills the command with all its processes before the call
//   kill-one   kills the process that makes the call
//   ENOSPC ..  lets the call fail so instead of doing anything; with a "+" at the end also every
//              later one
// Exits as the command does, with 128 and the signal's number if it was killed, and with 77 if
// processes cannot be traced here. Unlike strace's, its numbers run over all threads, so that there
// is a number for every call, and one process more or less changes nothing.
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include <elf.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

namespace {

constexpr int kSkipped = 77;

const std::map<std::string, long> kCalls = {{"openat", SYS_openat},
                                            {"read", SYS_read},
                                            {"write", SYS_write},
                                            {"writev", SYS_writev},
                                            {"pread64", SYS_pread64},
                                            {"pwrite64", SYS_pwrite64},
                                            {"fdatasync", SYS_fdatasync},
                                            {"fsync", SYS_fsync},
                                            {"rename", SYS_rename},
                                            {"unlink", SYS_unlink},
                                            {"ftruncate", SYS_ftruncate},
                                            {"truncate", SYS_truncate},
                                            {"mmap", SYS_mmap},
                                            {"munmap", SYS_munmap},
                                            {"close", SYS_close},
                                            {"newfstatat", SYS_newfstatat},
                                            {"fcntl", SYS_fcntl},
                                            {"flock", SYS_flock},
                                            {"mkdir", SYS_mkdir},
                                            {"getdents64", SYS_getdents64},
                                            {"lseek", SYS_lseek},
                                            {"clone", SYS_clone},
                                            {"clone3", SYS_clone3},
                                            {"futex", SYS_futex},
                                            {"madvise", SYS_madvise},
                                            {"mremap", SYS_mremap},
                                            {"mprotect", SYS_mprotect},
                                            {"readlink", SYS_readlink},
                                            {"stat", SYS_stat},
                                            {"lstat", SYS_lstat},
                                            {"fstat", SYS_fstat},
                                            {"access", SYS_access},
                                            {"getcwd", SYS_getcwd},
                                            {"brk", SYS_brk},
                                            {"fchown", SYS_fchown},
                                            {"chmod", SYS_chmod},
                                            {"wait4", SYS_wait4},
                                            {"statfs", SYS_statfs},
                                            {"getrandom", SYS_getrandom},
                                            {"prctl", SYS_prctl},
                                            {"rt_sigtimedwait", SYS_rt_sigtimedwait}};

const std::map<std::string, int> kErrors = {
    {"ENOSPC", ENOSPC}, {"EIO", EIO},       {"EMFILE", EMFILE}, {"EINTR", EINTR},
    {"ENOMEM", ENOMEM}, {"EACCES", EACCES}, {"EAGAIN", EAGAIN}, {"EROFS", EROFS},
    {"ENOLCK", ENOLCK}, {"EDQUOT", EDQUOT}, {"ENOENT", ENOENT}};

struct Fault {
  std::set<std::uint64_t> calls;
  std::uint64_t number = 0;
  std::string action;
  int error = 0;
  bool lasts = false;
};

[[noreturn]] void give_up(const char* what) {
  std::fprintf(stderr, "fault_at: %s: %s\n", what, std::strerror(errno));
  std::exit(errno == EPERM ? kSkipped : 1);
}

Fault fault_of(char** arguments) {
  Fault fault;
  std::istringstream list(arguments[0]);
  for (std::string name; std::getline(list, name, ',');) {
    const auto call = kCalls.find(name);
    if (call == kCalls.end()) {
      std::fprintf(stderr, "fault_at: unknown call %s\n", name.c_str());
      std::exit(2);
    }
    fault.calls.insert(static_cast<std::uint64_t>(call->second));
  }
  fault.number = std::strtoull(arguments[1], nullptr, 10);
  fault.action = arguments[2];
  fault.lasts = fault.action.back() == '+';
  if (fault.lasts) fault.action.pop_back();
  const auto error = kErrors.find(fault.action);
  if (error != kErrors.end()) fault.error = error->second;
  return fault;
}

// Returns where the dynamic loader lies in a process, or 0.
std::uint64_t loader_of(pid_t process) {
  std::ifstream stream("/proc/" + std::to_string(process) + "/auxv", std::ios::binary);
  std::array<std::uint64_t, 2> entry{};
  while (stream.read(reinterpret_cast<char*>(entry.data()), sizeof entry)) {
    if (entry[0] == AT_BASE) return entry[1];
  }
  return 0;
}

class Tracer {
 public:
  Tracer(const Fault& fault, pid_t command) : fault_(fault), command_(command) {}

  // Follows the command and all that it starts to their end. Returns the exit code.
  int run() {
    int status = 0;
    for (pid_t thread = 0; (thread = waitpid(-1, &status, __WALL)) > 0 || errno == EINTR;) {
      if (thread <= 0) continue;
      if (WIFSTOPPED(status)) {
        stopped(thread, status);
      } else if (thread == command_) {
        code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      }
    }
    if (fault_.action == "count") print_counts();
    return code_;
  }

 private:
  void print_counts() const {
    const auto print = [](const char* name, std::uint64_t count) {
      std::fprintf(stderr, "%s %llu\n", name, static_cast<unsigned long long>(count));
    };
    for (const auto& [name, call] : kCalls) {
      const auto count = counts_.find(static_cast<std::uint64_t>(call));
      if (count != counts_.end()) print(name.c_str(), count->second);
    }
    print("all", seen_);
  }

  void stopped(pid_t thread, int status) {
    int signal = WSTOPSIG(status);
    const int event = status >> 16;
    if (event == PTRACE_EVENT_EXEC) {
      loader_ = loader_of(thread);
    }
    if (signal == (SIGTRAP | 0x80)) {
      system_call(thread);
      signal = 0;
    } else if (event != 0 || (signal == SIGSTOP && known_.insert(thread).second)) {
      signal = 0;  // the stop that begins a traced thread
    }
    ptrace(PTRACE_SYSCALL, thread, nullptr, signal);
  }

  void system_call(pid_t thread) {
    __ptrace_syscall_info info{};
    if (ptrace(PTRACE_GET_SYSCALL_INFO, thread, sizeof info, &info) <= 0) return;
    if (info.op == PTRACE_SYSCALL_INFO_EXIT) {
      if (failing_.erase(thread) > 0) set_result(thread);
      return;
    }
    if (info.op != PTRACE_SYSCALL_INFO_ENTRY || !fault_.calls.contains(info.entry.nr)) return;
    // the loader of Debian 12 has 220 KB
    constexpr std::uint64_t kLoaderSize = 0x40000;
    if (info.instruction_pointer - loader_ < kLoaderSize) return;
    ++seen_;
    ++counts_[info.entry.nr];
    if (seen_ != fault_.number && !(fault_.lasts && seen_ > fault_.number)) return;
    if (fault_.action == "kill") kill(0, SIGKILL);
    if (fault_.action == "kill-one") kill(process_of(thread), SIGKILL);
    if (fault_.error != 0) {
      failing_.insert(thread);
      skip_call(thread);
    }
  }

  // The group of the command is a new one, which the tracer is not in.
  void kill(pid_t process, int signal) const { ::kill(process == 0 ? -command_ : process, signal); }

  static pid_t process_of(pid_t thread) {
    std::ifstream stream("/proc/" + std::to_string(thread) + "/status");
    for (std::string line; std::getline(stream, line);) {
      if (line.rfind("Tgid:", 0) == 0) return std::stoi(line.substr(5));
    }
    return thread;
  }

  static void skip_call(pid_t thread) {
    user_regs_struct registers{};
    ptrace(PTRACE_GETREGS, thread, nullptr, &registers);
    registers.orig_rax = ~0ULL;
    ptrace(PTRACE_SETREGS, thread, nullptr, &registers);
  }

  void set_result(pid_t thread) const {
    user_regs_struct registers{};
    ptrace(PTRACE_GETREGS, thread, nullptr, &registers);
    registers.rax = static_cast<unsigned long long>(-static_cast<long long>(fault_.error));
    ptrace(PTRACE_SETREGS, thread, nullptr, &registers);
  }

  const Fault& fault_;
  pid_t command_;
  std::uint64_t loader_ = 0;
  std::uint64_t seen_ = 0;
  std::map<std::uint64_t, std::uint64_t> counts_;  // by call
  std::set<pid_t> known_;
  std::set<pid_t> failing_;
  int code_ = 1;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fputs("usage: fault_at CALLS NUMBER ACTION COMMAND [ARGUMENT...]\n", stderr);
    return 2;
  }
  const Fault fault = fault_of(argv + 1);
  const pid_t command = fork();
  if (command < 0) give_up("fork");
  if (command == 0) {
    setpgid(0, 0);
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(kSkipped);
    raise(SIGSTOP);
    execvp(argv[4], argv + 4);
    _exit(127);
  }
  int status = 0;
  waitpid(command, &status, 0);
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  constexpr long kOptions = PTRACE_O_TRACESYSGOOD | PTRACE_O_TRACEFORK | PTRACE_O_TRACEVFORK |
                            PTRACE_O_TRACECLONE | PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL;
  if (ptrace(PTRACE_SETOPTIONS, command, nullptr, kOptions) != 0) give_up("ptrace");
  ptrace(PTRACE_SYSCALL, command, nullptr, nullptr);
  return Tracer(fault, command).run();
}
