; Later patterns count more.
(identifier) @variable
(line_comment) @comment
(block_comment) @comment

(param name: (identifier) @variable.parameter)
(struct_member name: (identifier) @property)
(named_component_expression component: (_) @property)

(type_specifier (identifier) @type)
(struct_decl name: (identifier) @type)
(type_alias_decl name: (identifier) @type)
(function_header name: (identifier) @function)
(call_expression (identifier) @function)
(func_call_statement (identifier) @function)

(import_path (identifier) @module)
(ident_path (identifier) @module)
(attribute "@" @attribute)
(attribute name: (identifier) @attribute)

(bool_literal) @boolean
(int_literal) @number
(float_literal) @number

[
  "alias" "as" "break" "case" "const" "const_assert" "continue" "continuing" "default" "discard"
  "else" "fn" "for" "if" "import" "let" "loop" "override" "return" "struct" "switch" "var" "while"
] @keyword

["(" ")" "[" "]" "{" "}"] @punctuation.bracket
["," "." ":" ";" "::"] @punctuation.delimiter
