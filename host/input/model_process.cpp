#include "model_process.hpp"

#include "scene/model.hpp"
#include "scene/model_stream.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>

#include <fcntl.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ; // NOLINT(readability-redundant-declaration): POSIX leaves it to the program

namespace postfx::host {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true; // wants terabytes of addresses, and takes its time
#else
constexpr bool sanitized = false;
#endif

constexpr rlim_t mebibyte = rlim_t{1} << 20u;

/// What a process that reads a model may use. Every file that it opens brings more.
class Allowance {
public:
    Allowance() {
        rlimit no_core{0, 0};
        ::setrlimit(RLIMIT_CORE, &no_core);
        apply();
    }

    void add_file(std::uintmax_t bytes) {
        // Two seconds for each MiB: the slowest formats are text, and read at more than 5 MB/s.
        milliseconds_ += (files_++ == 0 ? 0 : 1000) + bytes * 2000 / mebibyte;
        memory_ += 64 * bytes; // text as geometry, deflated pictures as pixels
        apply();
    }

private:
    void apply() const {
        limit(RLIMIT_CPU, milliseconds_ / 1000 * (sanitized ? 10 : 1));
        if (!sanitized) limit(RLIMIT_AS, memory_);
        // For what waits and uses no processor; ten times as long, since others may be using it.
        ::alarm(static_cast<unsigned>(20 + milliseconds_ / 100));
    }

    static void limit(decltype(RLIMIT_AS) what, rlim_t value) {
        rlimit now{};
        ::getrlimit(what, &now);
        now.rlim_cur = std::min(value, now.rlim_max);
        ::setrlimit(what, &now);
    }

    std::uintmax_t milliseconds_ = 1000, files_ = 0;
    rlim_t memory_ = 768 * mebibyte; ///< of addresses; the program itself has some 200 MiB of them
};

void write_all(int file, const void* bytes, std::size_t size) {
    const auto* at = static_cast<const char*>(bytes);
    while (size > 0) {
        const ssize_t written = ::write(file, at, size);
        if (written < 0 && errno != EINTR) ::_exit(1); // nobody listens any more
        if (written <= 0) continue;
        at += written;
        size -= static_cast<std::size_t>(written);
    }
}

/// The other end of a child's standard output.
class Child {
public:
    explicit Child(const std::filesystem::path& file) {
        int ends[2];
        if (::pipe2(ends, O_CLOEXEC) != 0) throw Error("can't make a pipe for reading models");
        output_ = ends[0];
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
        ::posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
        ::posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
        std::string words[] = {"postfx", "read-model", "--", file.string()};
        char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), nullptr};
        const int problem = ::posix_spawn(&process_, "/proc/self/exe", &actions, nullptr, arguments, environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(ends[1]);
        if (problem != 0) {
            ::close(output_);
            throw Error(fmt::format("can't start a process for reading models: {}", std::strerror(problem)));
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;
    ~Child() {
        if (process_ > 0) {
            ::kill(process_, SIGKILL);
            wait();
        }
        ::close(output_);
    }

    void read(void* bytes, std::size_t size) const {
        auto* at = static_cast<char*>(bytes);
        while (size > 0) {
            const ssize_t count = ::read(output_, at, size);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) throw std::runtime_error("the reader stopped");
            at += count;
            size -= static_cast<std::size_t>(count);
        }
    }
    /// Its status as waitpid has it.
    int wait() {
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
        return status;
    }

private:
    pid_t process_ = -1;
    int output_ = -1;
};

std::string death_of(int status) {
    if (!WIFSIGNALED(status)) return fmt::format("the reader stopped with status {}", WEXITSTATUS(status));
    switch (WTERMSIG(status)) {
    case SIGXCPU:
    case SIGALRM:
        return "the reader ran out of time";
    case SIGKILL:
        return "the reader was killed, perhaps for want of memory";
    default:
        return fmt::format("the reader crashed ({})", ::strsignal(WTERMSIG(status)));
    }
}

/// More than this is not taken from a reader, whatever the file.
std::size_t half_of_memory() {
    const long pages = ::sysconf(_SC_PHYS_PAGES), page = ::sysconf(_SC_PAGESIZE);
    return static_cast<std::size_t>(pages) / 2 * static_cast<std::size_t>(page);
}

} // namespace

Model read_model_in_child(const std::filesystem::path& file) {
    Child child(file);
    const auto fail = [&](const std::string& why) {
        return Error(Place{.file = file.string()}, fmt::format("can't read this model: {}", why));
    };
    try {
        return read_model_stream([&](void* bytes, std::size_t size) { child.read(bytes, size); },
                                 half_of_memory());
    } catch (const Error&) {
        throw;
    } catch (const std::bad_alloc&) {
        throw fail("the reader ran out of memory");
    } catch (const std::runtime_error&) {
        throw fail(death_of(child.wait()));
    }
}

void read_model_for_parent(const std::filesystem::path& file) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int output = ::dup(STDOUT_FILENO);
    if (!std::freopen("/dev/null", "w", stdout)) ::_exit(1); // libraries may print what they like
    ModelWriter writer([output](const void* bytes, std::size_t size) { write_all(output, bytes, size); });
    Allowance allowance;
    const ReadingHooks hooks{.opening = [&](std::uintmax_t bytes) { allowance.add_file(bytes); },
                             .picture = [&](PicturePtr picture) { return writer.picture(picture); }};
    try {
        writer.model(load_model(file, hooks));
    } catch (const Error& error) {
        writer.error(error);
    } catch (const std::bad_alloc&) {
        writer.out_of_memory();
    } catch (const std::exception& error) {
        writer.error(
            Error(Place{.file = file.string()}, fmt::format("can't read this model: {}", error.what())));
    }
}

} // namespace postfx::host
