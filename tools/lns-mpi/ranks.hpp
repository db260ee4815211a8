#pragma once
// The processes of an MPI job, and all traffic between them. The traffic is counted. Ranks sleep while they wait, so
// that more ranks than processors do not take time from each other.

#include <mpi.h>

#include <cstdint>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/run/error.hpp"

namespace hexpipe::lns_mpi {

using Bytes = std::vector<char>;

struct Traffic {
  std::int64_t messages = 0, bytes = 0;  // sent from rank to rank
  std::int64_t collectives = 0;          // reductions and broadcasts of a few numbers, each log2(ranks) deep
  Traffic operator-(const Traffic& other) const {
    return {messages - other.messages, bytes - other.bytes, collectives - other.collectives};
  }
};

// An error that all ranks throw together; one of them says why.
class ErrorOfAll : public std::runtime_error {
 public:
  ErrorOfAll(const std::string& message, bool of_usage) : std::runtime_error(message), of_usage_(of_usage) {}
  // True: the error is in the command line; false: in the data.
  bool of_usage() const { return of_usage_; }

 private:
  bool of_usage_;
};

class Ranks {
 public:
  // Begins MPI, and ends it in the destructor. There may be only one object.
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int count() const { return count_; }
  bool is_first() const { return rank_ == 0; }
  const Traffic& traffic() const { return traffic_; }

  // Runs task() on every rank; none goes on before all are done. When it throws on some ranks, all ranks throw
  // ErrorOfAll, and only the first of the failed ones reports.
  template <class Task>
  void together(Task&& task) {
    std::string error;
    Failure failure = Failure::none;
    try {
      task();
    } catch (const UsageError& exception) {
      failure = Failure::usage;
      error = exception.what();
    } catch (const std::bad_alloc&) {
      failure = Failure::data;
      error = "not enough memory";
    } catch (const std::exception& exception) {
      failure = Failure::data;
      error = exception.what();
    }
    agree(failure, error);
  }

  // Each entry becomes the sum, or the greatest, over all ranks.
  void sum(std::span<std::int64_t> values);
  void maximum(std::span<std::int64_t> values);
  // All ranks get the bytes of the first one.
  void broadcast(Bytes& bytes);

  // to[r] goes to rank r; returns what came from each rank. For the few times when any rank may have data for any
  // other.
  std::vector<Bytes> all_to_all(std::vector<Bytes> to);
  // to[i] goes to partners[i], which must have this rank among its partners, too; returns what came from each partner.
  std::vector<Bytes> all_to_all(std::span<const int> partners, const std::vector<Bytes>& to);
  // Sends to one rank, which has to call receive.
  void send(int to, const Bytes& bytes);
  Bytes receive(int from);

  // Whether this process has called MPI, which it can do only once.
  static bool were_started();

  // Ends all ranks at once, after this one has said why.
  [[noreturn]] static void abandon();

 private:
  enum class Failure { none, data, usage };
  void agree(Failure failure, const std::string& error);
  void post_send(int to, const Bytes& bytes);
  void post_receive(int from, Bytes& bytes);
  void wait();

  int rank_ = 0, count_ = 1;
  Traffic traffic_;
  std::vector<MPI_Request> requests_;
};

// The number that mpirun or another launcher gave this process, known before MPI begins.
std::optional<int> launched_rank();

// Packer puts numbers and arrays of numbers into bytes; Unpacker takes them out in the same order.
class Packer {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    append(&value, sizeof value);
  }
  template <class T>
  void put_all(std::span<const T> values) {
    put(static_cast<std::uint64_t>(values.size()));
    append(values.data(), values.size_bytes());
  }
  Bytes take() { return std::exchange(bytes_, {}); }

 private:
  void append(const void* data, std::size_t size) {
    const auto* const first = static_cast<const char*>(data);
    bytes_.insert(bytes_.end(), first, first + size);
  }
  Bytes bytes_;
};

class Unpacker {
 public:
  explicit Unpacker(const Bytes& bytes) : bytes_(bytes) {}
  bool at_end() const { return next_ == bytes_.size(); }
  template <class T>
  T get() {
    T value;
    std::memcpy(&value, bytes_.data() + next_, sizeof value);
    next_ += sizeof value;
    return value;
  }
  // Appends to `values`.
  template <class T>
  void get_all(std::vector<T>& values) {
    const auto count = static_cast<std::size_t>(get<std::uint64_t>());
    const std::size_t before = values.size();
    values.resize(before + count);
    if (count > 0) std::memcpy(values.data() + before, bytes_.data() + next_, count * sizeof(T));
    next_ += count * sizeof(T);
  }

 private:
  const Bytes& bytes_;
  std::size_t next_ = 0;
};

}  // namespace hexpipe::lns_mpi
