#pragma once
// A pipe of tools fails once: the tool at fault says why, and its neighbours end without a word.
//
// The failing tool leaves a mark on its pipes that costs no byte of data: it sets their time of modification, which
// both ends of a pipe see. The nanoseconds tell which end failed, the seconds how many bytes were written, so that a
// mark is void when another program wrote more (`wrap scan.stl || cat closed.stl`). Only nameless pipes are marked.
// Where the system does not keep the mark, each tool reports what it finds.

#include <cstddef>

namespace hexpipe {

// The code that writes to standard output, or reads from standard input, reports here how that goes.
void count_written_to_stdout(std::size_t bytes);
void count_read_from_stdin(std::size_t bytes);
void note_end_of_stdin();
void note_broken_stdout();

// Marks the pipes at standard input and output. Signal handlers may call it.
void mark_pipes_as_failed();

// Standard input ended because the tool that writes to it failed.
bool writer_has_failed();
// Standard output broke because the tool that reads it failed.
bool reader_has_failed();

}  // namespace hexpipe
