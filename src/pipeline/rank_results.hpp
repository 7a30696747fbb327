#pragma once

#include "lamella/pipeline/ranks.hpp"
#include "lamella/pipeline/slice_file.hpp"

namespace lamella {

/// Makes of what each rank gathered about the layers of its slab what one process gathers about all of them:
/// counts are added up, layers put together in the order of the ranks, times are the longest.
void put_together(FileResult& result, Communicator& ranks);

} // namespace lamella
