# Makes a C++ source out of the examples in the head comments of headers.
#
#     awk -v folder=core -v root=SOURCE_FOLDER -v output=SOURCE -f header_examples.awk HEADER…
#
# Beside this file FOLDER_context.h has the objects that the examples take for granted, as members
# of a struct Context: that of the namespace in_FOLDER, or of a header's own, in_FOLDER::FILE_h.
# Each example is a member function of a class derived from it, and is run on an object of its own.
# The context also says, by the headers' names, what becomes of examples that are not simply run:
#
#     // Not run: common/input_file.h: REASON
#     // Throws: common/error.h
#
# An example is what stands four columns into the head comment after an empty line. Its parts, cut
# at empty lines, become
#
#     nothing          when they show lines of a file: they begin with a tag, EDGE_NAME and a space
#     declarations     when they begin with struct, class, template, void, or LOCOGRAPH_
#     statements       of one function for each example, otherwise
#
# Tables and formulae stand two columns into the comment, and are no examples. What stands four
# columns in and is neither fails, so that no example is left out.

BEGIN {
  context = root "/tests/documentation/" folder "_context.h"
  while ((status = getline line < context) > 0) {
    if (line !~ /^\/\/ (Not run|Throws): /) continue
    kind = line ~ /^\/\/ Throws/ ? "throws" : "not_run"
    sub(/^[^:]*: /, "", line)
    marked = line
    sub(/:.*/, "", marked)
    reason = substr(line, length(marked) + 3)
    if (kind == "not_run" && reason == "") {
      print context ": expected a reason why " marked " is not run" > "/dev/stderr"
      exit (failed = 1)
    }
    mark[marked] = kind == "throws" ? "kThrows" : "kNotRun"
    reason_of[marked] = reason
  }
  if (status < 0) {
    print context ": expected a context for the examples" > "/dev/stderr"
    exit (failed = 1)
  }
  includes = "// Made by header_examples.awk. Do not edit.\n" \
             "#include <documentation/example_context.h>\n" \
             "#include <documentation/" folder "_context.h>\n"
}

FNR == 1 {
  finish_header()
  file = FILENAME
  header = substr(file, length(root) + 2)
  ++headers
  includes = includes "#include <locograph/" header ">\n"
  name = header
  sub(/^[^\/]*\//, "", name)
  gsub(/[^a-z0-9]/, "_", name)
  in_head = 0
  past_head = 0
  after_empty = 0
  in_table = 0
  example = ""
  declarations = ""
  functions = ""
  count = 0
}

past_head { next }

!/^\/\/\// {
  if (in_head) past_head = 1
  else if (FNR > 1 && $0 != "") past_head = 1
  next
}

{
  in_head = 1
  if ($0 == "///") {
    finish_part()
    after_empty = 1
    next
  }
  code = /^\/\/\/     / && (after_empty || part != "")
  if (!code) {
    finish_example()
    if (/^\/\/\/ ? ?[0-9]+\. / || /^\/\/\/   [^ ]/) in_table = 1
    else if (after_empty) in_table = 0
    if (/^\/\/\/     [^ ]/ && !in_table) fail("an empty line before an example, or two columns for a table")
    after_empty = 0
    next
  }
  after_empty = 0
  if (part == "") {
    part = "#line " FNR " \"" file "\"\n"
    kind = ""
  }
  text = substr($0, 9)
  if (kind == "" && text !~ /^\/\//) kind = kind_of(text)
  part = part text "\n"
}

END {
  if (!failed) finish_header()
  if (!failed) {
    for (marked in mark) fail_mark(marked)
  }
  if (failed || headers == 0) exit 1
  printf "%snamespace locograph::documentation::in_%s {\n%s" \
         "const Registration registered({\n%s});\n}\n", includes, folder, bodies, entries > output
  print folder ": " headers " headers, " with_example " with an example"
}

function fail(expected) {
  print file ":" FNR ": expected " expected > "/dev/stderr"
  failed = 1
  exit 1
}

function fail_mark(marked) {
  print context ": expected an example in " marked ", which is marked here" > "/dev/stderr"
  failed = 1
}

function kind_of(text) {
  if (text ~ /^[A-Z][A-Z0-9]*_[A-Z0-9_:]+ /) return "file"
  if (text ~ /^(struct|class|template|void|LOCOGRAPH_)/) return "declaration"
  return "statement"
}

function finish_part() {
  if (part != "") {
    if (kind == "declaration") declarations = declarations part
    else if (kind != "file") example = example part
  }
  part = ""
}

function finish_example() {
  finish_part()
  if (example != "") {
    ++count
    functions = functions "Anything example_" count "() {\n" example "return {};\n}\n"
    how = header in mark ? mark[header] : "kRuns"
    entries = entries "{\"" header "\", " count ", Example::" how ", \"" reason_of[header] "\",\n" \
              " [] { " name "::Examples().example_" count "(); }},\n"
  }
  example = ""
}

function finish_header() {
  if (file == "") return
  finish_example()
  if (!in_head) fail("a head comment in the file before")
  if (declarations functions == "") return
  ++with_example
  delete mark[header]
  bodies = bodies "namespace " name " {\n" declarations
  if (functions != "") bodies = bodies "struct Examples : Context {\n" functions "};\n"
  bodies = bodies "}\n"
}
