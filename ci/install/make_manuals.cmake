# Manual pages of `programs` into out/man1, and the package's changelog, packed as Debian has them.
file(REMOVE_RECURSE ${out}/man1)
file(MAKE_DIRECTORY ${out}/man1)
foreach(program ${programs})
  get_filename_component(name ${program} NAME)
  set(help --help)
  if(name STREQUAL "strata")
    set(help --help-all)
  endif()
  execute_process(COMMAND help2man --no-info --version-string=${version} --help-option=${help} --include ${here}/${name}.h2m --output ${out}/man1/${name}.1 ${program}
    COMMAND_ERROR_IS_FATAL ANY)
  file(READ ${out}/man1/${name}.1 text)  # headings of commands
  string(REPLACE "\nSubcommands:\n" "\n.SH COMMANDS\n.PP\n" text "${text}")
  string(REGEX REPLACE "\n.PP\n([a-z]+)\n.IP\n" "\n.SS \\1\n" text "${text}")
  string(REGEX REPLACE "(\n.SS \"|\n.IP\n|\n)(Options|Positionals):\"?\n" "\n" text "${text}")
  file(WRITE ${out}/man1/${name}.1 "${text}")
  execute_process(COMMAND gzip -9n ${out}/man1/${name}.1 COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(COMMAND gzip -9nkf ${out}/changelog COMMAND_ERROR_IS_FATAL ANY)
