#pragma once
/// An open file that is closed with the scope.
///
///     const FileDescriptor file(::open("/proc/self/maps", O_RDONLY | O_CLOEXEC));
///     if (file.is_open()) ::lseek(file.get(), 100, SEEK_SET);

#include <fcntl.h>
#include <unistd.h>

#include <utility>

namespace locograph {

class FileDescriptor {
 public:
  explicit FileDescriptor(int number = -1) : number_(number) {}
  ~FileDescriptor() {
    if (is_open()) ::close(number_);
  }
  FileDescriptor(FileDescriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  FileDescriptor& operator=(FileDescriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }

  bool is_open() const { return number_ >= 0; }
  int get() const { return number_; }
  /// The caller closes it.
  int release() { return std::exchange(number_, -1); }

 private:
  int number_;
};

}  // namespace locograph
