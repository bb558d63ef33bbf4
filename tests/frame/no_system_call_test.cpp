// SPDX-License-Identifier: BSD-3-Clause
// Frames in a process that the kernel ends at its first system call, and that counts the locks it takes.
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>

#include "frame/every_frame.hpp"

#if defined(__linux__) && defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define SKINBEM_FORBIDS_SYSTEM_CALLS
#include <dlfcn.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstddef>

namespace {
std::atomic<long> locks = 0;
}

/// In the place of the C library's, which it calls.
extern "C" int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static const auto lock = reinterpret_cast<int (*)(pthread_mutex_t*)>(dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++locks;
  return lock(mutex);
}
#endif

namespace skinbem {
namespace {

#ifndef SKINBEM_FORBIDS_SYSTEM_CALLS

TEST(Frame, MakesNoSystemCallAndTakesNoLock) { GTEST_SKIP() << "Linux, glibc, and without sanitizers only"; }

#else

/// From here on this thread may only end the process; any other system call kills it.
bool forbid_system_calls() {
  sock_filter filter[] = {
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_exit_group, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
  };
  const sock_fprog program = {4, filter};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

constexpr int kGood = 7, kBad = 8, kCannotForbid = 9;

/// How a child ends that does `work` without system calls: its exit code, or minus the signal that killed it.
template <class Work>
int without_system_calls(const Work& work) {
  const pid_t child = fork();
  if (child == 0) {
    testing_support::EveryFrame frames;
    bool good = frames.run();  // what is made at the first use is made
    if (!forbid_system_calls()) _exit(kCannotForbid);
    good = work(frames) && good;
    _exit(good ? kGood : kBad);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

bool frames_without_locks(testing_support::EveryFrame& frames) {
  const long before = locks;
  bool good = true;
  for (int i = 0; i < 300; ++i) good = frames.run() && good;
  return good && locks == before;
}

TEST(Frame, MakesNoSystemCallAndTakesNoLock) {
  const int ended = without_system_calls(frames_without_locks);
  if (ended == kCannotForbid) GTEST_SKIP() << "this system has no filters of system calls";
  EXPECT_EQ(ended, kGood);
}

TEST(Frame, WithASystemCallOrALockWouldBeNoticed) {
  const int ended = without_system_calls([](auto&) { return syscall(SYS_getppid) > 0; });
  if (ended == kCannotForbid) GTEST_SKIP() << "this system has no filters of system calls";
  EXPECT_EQ(ended, -SIGSYS);
  std::mutex mutex;
  const long before = locks;
  mutex.lock();
  mutex.unlock();
  EXPECT_EQ(locks, before + 1);
}

#endif

}  // namespace
}  // namespace skinbem
