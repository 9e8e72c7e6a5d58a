/**
 * @file The grammar of Hyde for editors. The grammar of record is `grammar/hyde.pest`; the order of the rules is the same here.
 * @license MIT OR Apache-2.0
 *
 * It accepts more than the compiler in two places: a keyword is a name where no keyword can stand, and `end` has any name.
 */

/// <reference types="tree-sitter-cli/dsl" />
// @ts-check

// From the loosest to the tightest, as in Modelica.
const PREC = { conditional: 0, or: 1, and: 2, not: 3, compare: 4, plus: 5, sign: 6, times: 7, power: 8 };

// Words that open an element of a class or of a mode and that are names elsewhere. Other words of one place, such as `over`,
// stand where no name can stand.
const OPENING = [
  'size', 'shape', 'wrap', 'add', 'replace', 'signature', 'confounds', 'measure', 'stored', 'dissipated', 'supplied', 'enter',
  'leave',
];

/** One or more, separated by commas. */
const list = rule => seq(rule, repeat(seq(',', rule)));

/** A statement of several optional parts in this order, of which there is at least one. */
const some = parts => choice(...parts.map((part, index) => seq(part, ...parts.slice(index + 1).map(next => optional(next)))));

module.exports = grammar({
  name: 'hyde',

  word: $ => $.identifier,

  extras: $ => [/\s/, $.comment],

  supertypes: $ => [$.expression],

  inline: $ => [$._name, $._quoted, $._part, $._member, $._index],

  conflicts: $ => [
    // `a.b x;` declares, `a.b = x;` is an equation.
    [$.path, $.reference],
    // `import a.b.*;` and the wildcards of a study.
    [$.path],
    // `with A on x, y, B on z`: a comma separates sites and effects.
    [$.effect_use],
  ],

  rules: {
    // A file is one package.
    source_file: $ => seq(repeat($._part_of_file), optional(seq($.package_clause, repeat($._part_of_file)))),
    _part_of_file: $ => choice($.import_clause, $._item),

    // ---- words ---------------------------------------------------------------------------------------------------
    comment: _ => token(choice(/\/\/[^\n]*/, /\/\*[^*]*\*+([^/*][^*]*\*+)*\//)),
    identifier: _ => /[A-Za-z_][A-Za-z0-9_]*/,
    _name: $ => choice($.identifier, alias($._opening, $.identifier)),
    _opening: _ => choice(...OPENING),

    // ---- expressions ---------------------------------------------------------------------------------------------
    number: _ => /[0-9]+(\.[0-9]+)?([eE][+-]?[0-9]+)?/,
    unit: $ => seq('[', optional($.unit_text), ']'),
    unit_text: _ => token(prec(1, /[^\[\]\s][^\[\]\n]*/)),
    quantity: $ => seq($.number, optional(field('unit', $.unit))),
    string: $ => $._quoted,
    // A text behind a header is always its documentation.
    doc: $ => prec(1, $._quoted),
    _quoted: $ => seq('"', repeat(choice($._string_content, $.escape_sequence)), token.immediate('"')),
    _string_content: _ => token.immediate(prec(1, /[^"\\]+/)),
    escape_sequence: _ => token.immediate(prec(1, /\\(.|\n)/)),
    boolean: _ => choice('true', 'false'),

    expression: $ => choice(
      $.unary_expression, $.binary_expression, $.quantity, $.string, $.boolean, $.conditional, $.array, $.group, $.reference,
      $.call,
    ),
    unary_expression: $ => choice(
      ...[['-', PREC.sign], ['+', PREC.sign], ['not', PREC.not]].map(([operator, precedence]) =>
        prec(Number(precedence), seq(field('operator', operator), field('operand', $.expression)))),
    ),
    binary_expression: $ => choice(
      ...[
        ['or', PREC.or], ['and', PREC.and], ['<=', PREC.compare], ['>=', PREC.compare], ['<>', PREC.compare],
        ['==', PREC.compare], ['<', PREC.compare], ['>', PREC.compare], ['+', PREC.plus], ['-', PREC.plus], ['*', PREC.times],
        ['/', PREC.times],
      ].map(([operator, precedence]) => prec.left(Number(precedence), infix($, operator))),
      prec.right(PREC.power, infix($, '^')),
    ),
    group: $ => seq('(', $.expression, ')'),
    conditional: $ => prec.right(PREC.conditional, seq(
      'if', field('condition', $.expression), 'then', field('value', $.expression),
      repeat(seq('elseif', field('condition', $.expression), 'then', field('value', $.expression))),
      'else', field('value', $.expression),
    )),
    array: $ => seq(
      '{', $.expression, choice($.comprehension, repeat(seq(',', $.expression))), '}', optional(field('unit', $.unit)),
    ),
    comprehension: $ => seq(
      'for', field('variable', $.identifier), 'in', field('from', $.expression), ':', field('to', $.expression),
    ),
    call: $ => seq(field('function', $.reference), field('arguments', $.arguments)),
    arguments: $ => seq('(', optional(list($.argument)), ')'),
    argument: $ => seq(optional(seq(field('name', $._name), '=')), field('value', $.expression)),
    reference: $ => seq($._part, repeat(seq('.', $._member))),
    _part: $ => seq($._name, optional($.subscript)),
    // Any word, also one of the language; a column of a record may be called anything.
    _member: $ => seq(choice(alias($.identifier, $.member), alias($.string, $.quoted_member)), optional($.subscript)),
    subscript: $ => seq('[', list($._index), ']'),
    _index: $ => choice($.expression, $.slice),
    slice: $ => seq(field('from', $.expression), ':', field('to', $.expression)),
    range: $ => seq(field('from', $.expression), '..', field('to', $.expression)),
    path: $ => seq($.identifier, repeat(seq('.', $.identifier))),
    wildcard: $ => seq($.path, '.', '*'),

    // ---- files and items -----------------------------------------------------------------------------------------
    package_clause: $ => seq('package', field('name', alias($.path, $.package_name)), optional(field('doc', $.doc)), ';'),
    import_clause: $ => seq('import', choice($.path, $.wildcard), ';'),

    _item: $ => choice(
      $.type_item, $.fmu_item, $.short_item, $.model, $.connector, $.effect, $.function, $.experiment, $.study,
    ),
    type_item: $ => seq(
      'type', field('name', $.identifier), '=', field('base', $.path), optional(field('unit', $.unit)),
      optional(field('doc', $.doc)), ';',
    ),
    fmu_item: $ => seq(
      'model', field('name', $.identifier), '=', 'fmu', '(', field('file', $.string), repeat(seq(',', $._change)), ')',
      optional(field('doc', $.doc)), ';',
    ),
    short_item: $ => seq(
      'model', field('name', $.identifier), '=', field('base', $.path), optional($.modification), optional($.effects),
      optional(field('doc', $.doc)), ';',
    ),
    effects: $ => seq('with', list($.effect_use)),
    effect_use: $ => seq(field('effect', $.path), optional($.modification), 'on', list(field('site', $.reference))),

    model: $ => seq('model', ...class_like($)),
    connector: $ => seq('connector', ...class_like($)),
    effect: $ => seq('effect', ...class_like($)),
    function: $ => seq('function', ...class_like($)),
    host: $ => seq('on', $.path),
    end_clause: $ => seq('end', field('name', $.identifier), ';'),

    experiment: $ => seq(
      'experiment', field('name', $.identifier), optional($.records), 'of', field('model', $.path), optional($.modification),
      optional(field('doc', $.doc)), optional(';'), repeat($._experiment_item), $.end_clause,
    ),
    records: $ => seq('(', list($.record), ')'),
    record: $ => seq(
      'record', field('name', $.identifier), optional($.layout), optional($.every),
      optional(seq('=', field('file', $.string), optional($.layout_kind), optional($.layout), optional($.every))),
    ),
    layout_kind: $ => seq('layout', $.identifier),
    layout: $ => seq('(', list($.layout_setting), ')'),
    layout_setting: $ => seq(
      field('name', $.identifier), '=', field('value', choice($.string, $.number)), optional(seq('in', $.layout_unit)),
      optional($.layout_wraps),
    ),
    layout_unit: $ => seq(optional($.number), $.unit),
    layout_wraps: $ => seq('wraps', $.number),
    study: $ => seq(
      field('kind', $.study_kind), field('name', $.identifier), 'of', optional('calibrate'), list(field('of', $.path)),
      optional(field('doc', $.doc)), optional(';'), repeat($._study_item), $.end_clause,
    ),
    study_kind: _ => choice('calibrate', 'diagnose', 'sweep'),

    // ---- elements of classes -------------------------------------------------------------------------------------
    _element: $ => choice(
      $.extends_clause, $.domain, $.discretize, $.modes, $.clocked, $.wrap, $.add, $.replace, $.signature, $.confounds,
      $.measure, $.account, $.declaration, $._equation,
    ),
    equation_section: $ => seq(optional('initial'), 'equation', repeat($._element)),
    extends_clause: $ => seq('extends', field('base', $.path), optional($.modification), ';'),

    declaration: $ => seq(
      repeat($.prefix), field('type', $.path), optional($.subscript), list($.declarator), ';',
    ),
    prefix: _ => choice(
      'parameter', 'constant', 'final', 'flow', 'input', 'output', 'replaceable', 'site', 'field', 'size', 'shape',
    ),
    declarator: $ => seq(
      field('name', $.identifier), optional($.subscript), optional($.modification), optional($.on_domain), optional($.binding),
      optional($.prior), optional($.source), optional($.within), optional($.over_variables),
      optional(field('doc', $.doc)),
    ),
    on_domain: $ => seq('on', field('domain', $.identifier)),
    binding: $ => seq('=', field('value', $.expression)),
    prior: $ => seq('~', choice('±', '+/-', '+-'), $.number, optional(choice('%', $.unit))),
    source: $ => seq('from', $.string),
    within: $ => seq('in', $.range),
    over_variables: $ => seq('over', '(', list($.argument), ')'),

    modification: $ => seq('(', optional(list($._change)), ')'),
    _change: $ => choice($.redeclaration, $.change),
    redeclaration: $ => seq('redeclare', field('type', $.path), field('name', $.identifier), optional($.modification)),
    change: $ => seq(
      optional('each'), optional('final'), field('name', $.reference), optional($.modification), optional($.binding),
      optional($.prior), optional($.source),
    ),

    domain: $ => seq(
      'domain', field('name', $.identifier), '(', field('coordinate', $.identifier), 'in', $.range, ')',
      optional(field('doc', $.doc)), ';',
    ),
    discretize: $ => seq(
      'discretize', field('domain', $.identifier), 'by', field('method', $.identifier), optional($.arguments), ';',
    ),

    modes: $ => prec.right(seq(
      'modes', optional(field('name', $.identifier)), 'initial', field('initial', $.identifier), optional($.arguments), '{',
      repeat1($.mode), '}', optional(';'),
    )),
    mode: $ => seq(
      'mode', field('name', $.identifier), optional($.mode_parameters), '{',
      repeat(choice($.exit, $.enter, $.leave, $._equation)), '}',
    ),
    mode_parameters: $ => seq('(', list($.mode_parameter), ')'),
    mode_parameter: $ => seq(field('type', $.path), field('name', $.identifier)),
    enter: $ => seq('enter', $.actions, optional(';')),
    leave: $ => seq('leave', $.actions, optional(';')),
    exit: $ => seq(
      'exit', field('guard', $.expression), '->', field('target', $.identifier), optional($.arguments),
      optional(choice('impact', $.actions)), ';',
    ),
    actions: $ => seq('{', repeat($._equation), '}'),

    clocked: $ => seq(
      'clocked', field('name', $.identifier), $.arguments, optional(field('doc', $.doc)), optional(';'), ...body($),
      $.end_clause,
    ),

    wrap: $ => seq('wrap', field('site', $.reference), 'by', field('value', $.expression), ';'),
    // `add -x = 1;` adds an equation: no name can stand there.
    add: $ => prec(1, seq('add', $._equation)),
    replace: $ => seq('replace', field('component', $.reference), 'by', field('type', $.path), optional($.modification), ';'),
    signature: $ => seq('signature', list($.mark), ';'),
    mark: $ => seq($.identifier, optional($.arguments)),
    confounds: $ => seq('confounds', list($.path), ';'),
    measure: $ => seq(
      'measure', field('type', $.path), field('name', $.identifier), '=', field('value', $.expression),
      optional(seq('in', field('unit', $.unit))), optional(field('doc', $.doc)), ';',
    ),
    account: $ => seq(
      choice('stored', 'dissipated', 'supplied'), field('type', $.path), field('name', $.identifier), '=',
      field('value', $.expression), optional(field('doc', $.doc)), ';',
    ),

    // ---- equations -----------------------------------------------------------------------------------------------
    _equation: $ => choice(
      $.connection, $.for_equation, $.if_equation, $.when_equation, $.assertion, $.reinit, $.equation,
    ),
    connection: $ => seq('connect', '(', $.reference, repeat1(seq(',', $.reference)), ')', ';'),
    for_equation: $ => seq(
      'for', field('variable', $.identifier), 'in', field('from', $.expression), ':', field('to', $.expression), 'loop',
      repeat($._equation), 'end', 'for', ';',
    ),
    if_equation: $ => seq(
      'if', field('condition', $.expression), 'then', optional($.equations),
      repeat(seq('elseif', field('condition', $.expression), 'then', optional($.equations))),
      optional(seq('else', optional($.equations))), 'end', 'if', ';',
    ),
    when_equation: $ => seq(
      'when', field('condition', $.expression), 'then', optional($.equations),
      repeat(seq('elsewhen', field('condition', $.expression), 'then', optional($.equations))), 'end', 'when', ';',
    ),
    equations: $ => repeat1($._equation),
    assertion: $ => seq('assert', '(', field('condition', $.expression), ',', field('message', $.string), ')', ';'),
    reinit: $ => seq('reinit', '(', field('variable', $.reference), ',', field('value', $.expression), ')', ';'),
    equation: $ => seq(field('left', $.expression), '=', field('right', $.expression), optional($.place), ';'),
    place: $ => seq('indomain', $.identifier, optional(seq('.', alias($.identifier, $.member))), repeat($.load)),
    load: $ => seq('load', '(', field('at', $.expression), ',', field('value', $.expression), ')'),

    // ---- elements of experiments and studies ---------------------------------------------------------------------
    _experiment_item: $ => choice(
      $.stimulus, $.measured, $.replay, $.expect, $.measure, $.figure, $.budget, $.run, $.bode, $.margins,
    ),
    stimulus: $ => seq('stimulus', list($.drive), ';'),
    drive: $ => seq(field('variable', $.reference), '=', field('value', $.expression), optional($.noise)),
    measured: $ => seq('measured', list($.channel), ';'),
    channel: $ => seq(
      field('signal', $.expression), '=', field('value', $.expression), optional($.noise), optional(field('doc', $.doc)),
    ),
    noise: $ => seq('~', $.expression),
    replay: $ => seq('replay', list($.drive), ';'),
    expect: $ => seq('expect', field('condition', $.expression), optional(field('doc', $.doc)), ';'),
    figure: $ => seq(
      'figure', field('name', $.identifier), '=', list($.expression), optional(seq('over', field('over', $.expression))),
      optional($.within), optional(field('doc', $.doc)), ';',
    ),
    budget: $ => seq('budget', list($.ideal), ';'),
    ideal: $ => seq(field('name', $.identifier), $.modification, optional(field('doc', $.doc))),
    run: $ => seq(some([$.solve, $.start, $.stop, $.every, $.skip]), ';'),
    solve: $ => seq('solve', field('method', $.identifier), optional($.arguments)),
    start: $ => seq('start', $.expression),
    stop: $ => seq('stop', $.expression),
    every: $ => seq('every', $.expression),
    skip: $ => seq('skip', $.expression),
    bode: $ => seq(
      'bode', 'from', field('input', $.reference), 'to', list(field('output', $.expression)), 'over', $.range,
      optional($.by_steps), optional($.at_point), optional($.in_modes), ';',
    ),
    margins: $ => seq(
      'margins', 'of', list($.reference), optional(seq('over', $.range)), optional($.at_point), optional($.in_modes), ';',
    ),
    by_steps: $ => seq('by', $.identifier, optional($.arguments)),
    at_point: $ => seq('at', $.expression),
    in_modes: $ => seq('in', list($.in_mode)),
    in_mode: $ => seq(field('component', $.reference), '=', field('mode', $.identifier)),

    _study_item: $ => choice($.vary, $.setting),
    vary: $ => seq('vary', choice(seq('effect', list($.effect_use)), list($.variation), $.wildcard), ';'),
    variation: $ => choice(
      seq('model', $.binding),
      seq(
        optional(choice('stimulus', 'record')), field('name', $.reference), optional(choice($.within, $.binding)),
        optional($.per),
      ),
    ),
    per: $ => seq('per', choice('experiment', $.identifier)),
    setting: $ => seq(
      field('name', $.identifier),
      optional(seq($._setting_value, repeat(seq(',', $._setting_value)), optional($.at_labels))), ';',
    ),
    _setting_value: $ => choice($.wildcard, $.expression),
    at_labels: $ => seq('at', list($.label)),
    label: $ => seq(field('name', $.identifier), '=', field('value', $.expression)),
  },
});

/** An operator between two expressions. */
function infix($, operator) {
  return seq(field('left', $.expression), field('operator', operator), field('right', $.expression));
}

/** What follows the keyword of a class. */
function class_like($) {
  return [
    field('name', $.identifier), optional($.host), optional(field('doc', $.doc)), optional(';'), ...body($), $.end_clause,
  ];
}

/** Declarations, then sections of equations; in a section anything may stand. */
function body($) {
  return [repeat($._element), repeat($.equation_section)];
}
