#pragma once

namespace replay {

/// From now on the first Ctrl-C asks the run to finish early; a second one kills it.
void catchInterrupts();

/// Whether Ctrl-C was pressed.
bool interrupted();

/// The same for a study that compares: says on stderr that nothing was compared.
bool comparisonStopped();

}  // namespace replay
