// Ctrl-C and a request to terminate end a run after the frame in work, so that its files are whole and its report is
// written. One that comes half a second later or more ends the program at once. Those before count as the same:
// `timeout` sends two in a row.
#pragma once

namespace app {

// From now on SIGINT, SIGTERM and, unless it is ignored, SIGHUP are noted.
void noteInterrupts();
// Whether one has come.
bool interrupted();
// Whether a run of so many frames was to have more when one came; says so.
bool endedEarly(int frames, int asked);

}  // namespace app
