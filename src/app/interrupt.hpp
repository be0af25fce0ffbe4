#pragma once

namespace treacle {

/// From now on SIGINT and SIGTERM ask the run to stop after the step in progress; a second one ends the program.
void catchInterrupts();

/// Name of the signal that asked to stop, nullptr if none did.
const char* interruptSignal();

/// A write beyond the file size limit becomes an error that can be reported instead of ending the program.
void ignoreFileSizeSignal();

}  // namespace treacle
