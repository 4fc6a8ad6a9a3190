// The one part that is linked with MPI: a library of its own beside the program, loaded under mpirun alone.
#include <mpi.h>

#include "wingbeat/run/ranks.hpp"

namespace {

int start(int* rank, int* count) {
  int provided = 0;
  // Only the main thread communicates.
  if (const int error = MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided)) return error;
  if (const int error = MPI_Comm_rank(MPI_COMM_WORLD, rank)) return error;
  return MPI_Comm_size(MPI_COMM_WORLD, count);
}

int send(int to, int tag, const void* bytes, int length) {
  return MPI_Send(bytes, length, MPI_BYTE, to, tag, MPI_COMM_WORLD);
}

int probe(int wait, int* found, int* from, int* tag, int* length) {
  MPI_Status status;
  *found = 1;
  const int error = wait ? MPI_Probe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &status)
                         : MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, found, &status);
  if (error || !*found) return error;
  *from = status.MPI_SOURCE;
  *tag = status.MPI_TAG;
  return MPI_Get_count(&status, MPI_BYTE, length);
}

int receive(int from, int tag, void* bytes, int length) {
  return MPI_Recv(bytes, length, MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
}

void finish() { MPI_Finalize(); }

void abort_all() { MPI_Abort(MPI_COMM_WORLD, 1); }

}  // namespace

extern "C" __attribute__((visibility("default"))) const wingbeat::RankModule wingbeat_rank_module;
const wingbeat::RankModule wingbeat_rank_module = {start, send, probe, receive, finish, abort_all};
