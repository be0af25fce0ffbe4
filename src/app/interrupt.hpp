#pragma once

namespace treacle {

/// From now on SIGINT, SIGTERM and SIGHUP ask the run to stop after the step in progress; a second one ends the
/// program. A SIGHUP that is ignored stays so. Where nobody reads what is printed the run goes on.
void catchInterrupts();

/// Name of the signal that asked to stop, nullptr if none did.
const char* interruptSignal();

/// A write beyond the file size limit becomes an error that can be reported instead of ending the program.
void ignoreFileSizeSignal();

}  // namespace treacle
