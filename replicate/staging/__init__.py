"""Replace files of ours all together or not at all, and never a file of the user's.

A run writes into a hidden folder inside its target, `.replicate`. When everything is there and flushed to the disk, a
journal is renamed into place: this one step decides. Before it everything can be thrown away; after it everything is
carried out, by this run or, if it is killed, by the next one.

`staged`            a part of an output folder, whose manifest tells which files earlier runs wrote
`replace_files`     named files in any folder, for the accepted state, a new paper
`write_signed`      one file at a place that the user names: a chart, a page
`keep_file`         one more file in a folder that a run holds with `locked_folder`, for sweeps
`partial_of`        where such a file grows
`unchanged`         a run that is interrupted before its files are staged says so
`say`               a line on standard error for whoever waits
`files_of`          what earlier runs wrote
`write`             a file and its folders, in a folder that is thrown away if the run does not end
`finish_interrupted` before reading a folder that another run may have been killed in
"""

from replicate.staging.files import partial_of, write
from replicate.staging.journal import ROOM
from replicate.staging.kept import keep_file, locked_folder
from replicate.staging.signatures import signed, write_signed
from replicate.staging.stage import files_of, finish_interrupted, replace_files, say, staged, unchanged

__all__ = [
    "ROOM",
    "files_of",
    "finish_interrupted",
    "keep_file",
    "locked_folder",
    "partial_of",
    "replace_files",
    "say",
    "signed",
    "staged",
    "unchanged",
    "write",
    "write_signed",
]
