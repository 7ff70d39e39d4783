// PID 1 of the lab guest: loads the modules, lays the host's root (9p, read-only) under a tmpfs overlay, runs
// /lab/job.sh in it and hands the exit status back. Static, so that it needs nothing of the host's root.
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <net/if.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/io.h>
#include <sys/ioctl.h>
#include <sys/mount.h>
#include <sys/reboot.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

enum { kExitPort = 0x501, kSetupFailed = 100 };

static void finish(int code) {
  sync();
  // isa-debug-exit: QEMU ends with (value << 1) | 1.
  if (iopl(3) == 0) outb((unsigned char)code, kExitPort);
  reboot(RB_POWER_OFF);
  for (;;) pause();
}

static void need(int ok, const char* what) {
  if (ok) return;
  fprintf(stderr, "lab guest: %s: %s\n", what, strerror(errno));
  finish(kSetupFailed);
}

static void load_modules(void) {
  FILE* list = fopen("/modules.list", "r");
  need(list != NULL, "modules.list");
  char path[256];
  while (fgets(path, sizeof path, list) != NULL) {
    path[strcspn(path, "\n")] = 0;
    const int fd = open(path, O_RDONLY | O_CLOEXEC);
    need(fd >= 0, path);
    if (syscall(SYS_finit_module, fd, "", 0) != 0 && errno != EEXIST) need(0, path);
    close(fd);
  }
  fclose(list);
}

static void raise_loopback(void) {
  const int s = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  struct ifreq request = {0};
  strcpy(request.ifr_name, "lo");
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  need(s >= 0 && ioctl(s, SIOCSIFFLAGS, &request) == 0, "lo up");
  close(s);
}

static void mount_root(void) {
  const char* options = "trans=virtio,version=9p2000.L,msize=512000,cache=loose";
  mkdir("/lower", 0755);
  mkdir("/over", 0755);
  mkdir("/root", 0755);
  need(mount("hostroot", "/lower", "9p", MS_RDONLY, options) == 0, "host root over 9p");
  need(mount("tmpfs", "/over", "tmpfs", 0, "size=70%") == 0, "tmpfs");
  mkdir("/over/upper", 0755);
  mkdir("/over/work", 0755);
  need(
      mount("overlay", "/root", "overlay", 0, "lowerdir=/lower,upperdir=/over/upper,workdir=/over/work") == 0,
      "overlay");
  need(mount("proc", "/root/proc", "proc", 0, NULL) == 0, "proc");
  need(mount("sysfs", "/root/sys", "sysfs", 0, NULL) == 0, "sysfs");
  need(mount("devtmpfs", "/root/dev", "devtmpfs", 0, NULL) == 0, "devtmpfs");
  mkdir("/root/dev/pts", 0755);
  mount("devpts", "/root/dev/pts", "devpts", 0, "ptmxmode=0666");
  mkdir("/root/dev/shm", 01777);
  mount("tmpfs", "/root/dev/shm", "tmpfs", 0, NULL);
  // A clone that lies below /tmp is to be seen.
  if (getenv("KINEBUS_HOST_TMP") == NULL) need(mount("tmpfs", "/root/tmp", "tmpfs", 0, NULL) == 0, "tmp");
  need(mount("tmpfs", "/root/run", "tmpfs", 0, NULL) == 0, "run");
  mount("configfs", "/root/sys/kernel/config", "configfs", 0, NULL);
  mkdir("/root/run/lab", 0755);
  need(mount("lab", "/root/run/lab", "9p", 0, "trans=virtio,version=9p2000.L,msize=512000,cache=none") == 0,
       "lab share");
  need(chroot("/root") == 0 && chdir("/") == 0, "chroot");
  if (symlink("/proc/self/fd", "/dev/fd") != 0 || symlink("/proc/self/fd/0", "/dev/stdin") != 0 ||
      symlink("/proc/self/fd/1", "/dev/stdout") != 0 || symlink("/proc/self/fd/2", "/dev/stderr") != 0)
    need(errno == EEXIST, "/dev/fd links");
}

int main(void) {
  mkdir("/dev", 0755);
  mount("devtmpfs", "/dev", "devtmpfs", 0, NULL);
  const int console = open("/dev/console", O_RDWR);
  if (console >= 0) {
    dup2(console, 0);
    dup2(console, 1);
    dup2(console, 2);
  }
  load_modules();
  mount_root();
  raise_loopback();
  sethostname("kinebus-lab", 11);

  const pid_t job = fork();
  need(job >= 0, "fork");
  if (job == 0) {
    setsid();
    char* const arguments[] = {"/bin/bash", "/run/lab/job.sh", NULL};
    char* const environment[] = {"PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin",
                                 "HOME=/tmp", "LANG=C.UTF-8", "KINEBUS_LAB=1", NULL};
    execve(arguments[0], arguments, environment);
    _exit(126);
  }
  int status = 0;
  for (pid_t ended; (ended = wait(&status)) != job;)
    if (ended < 0 && errno != EINTR) break;
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  FILE* result = fopen("/run/lab/status", "w");
  if (result != NULL) {
    fprintf(result, "%d\n", code);
    fclose(result);
  }
  finish(0);
}
