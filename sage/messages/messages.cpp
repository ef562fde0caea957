#include "sage/messages/messages.hpp"

#include <algorithm>

namespace sage {

namespace {

// By the first digit of the codes.
constexpr const char* kSections[] = {
    "S1: files, cards and layouts",
    "S2: cards that contradict each other or do not define a model",
    "S3: a model that sagefe can compute, but that may not be intended",
    "S4: refinement, grading and mid-side nodes",
    "S5: the analysis",
    "S6: results, checkpoints, plots, reports and some cards of stages",
    "S7: decks and meshes of other programs, Python, sweeps and partial factors",
    "S8: plug-ins and user materials (UMAT)",
    "S9: the command line",
};

constexpr MessageEntry kMessages[] = {
    // S1: files, cards and layouts.
    {"S101", "a file can't be read",
     "The file does not exist under this name, is a folder, or the user has no right to read it. A relative "
     "name starts at the folder in which the command is given, not at the folder of the deck.",
     "Check the name, and the access rights of the file with the command ls -l. A full path works from every "
     "folder."},
    {"S102", "a file is too large",
     "A deck may have up to 2 GiB and a layout up to 16 MiB. sagefe stops reading a pipe or a device at the "
     "same size. A deck of 5 million nodes is far below that limit.",
     "Check that the name is not that of a result, an archive or a device. If another program wrote the deck, "
     "look for a card that it repeated without end."},
    {"S103", "a file is empty",
     "The file has no card. A copy may have failed, the disk may have been full when the file was written, or "
     "the editor has not saved it yet.",
     "Copy or write the file again. The command ls -l shows its size."},
    {"S104", "a file is not a deck in plain text",
     "A deck is plain text with one card on each line. This file is binary, is UTF-16 text (as some Windows "
     "programs write it), or is a document of a word processor, a spreadsheet or an archive.",
     "Save the deck as plain text (ASCII or UTF-8) from the program that made it. Unpack an archive first. "
     "Other commands read other files: sagefe plot reads result files (.h5), sagefe convert reads meshes "
     "(.msh)."},
    {"S105", "no layout fits the deck",
     "sagefe recognises a layout by fixed words and numbers on its cards. The deck has those of no built-in "
     "layout, and its first cards do not fit sage1, the layout of sagefe itself. Probably another program "
     "wrote the deck, or an unknown version of a known one.",
     "If you know the layout, name it with --layout NAME or --layout FILE. Otherwise the command sagefe layout "
     "guess DECK writes a first layout. docs/manual/layout_guess.md explains how to complete it."},
    {"S106", "a deck of a program with another purpose",
     "The cards are those of a program for problems that sagefe does not solve, such as heat, vibration, "
     "plates or three dimensions.",
     "If sagefe guessed wrongly, name the layout with --layout. Otherwise you can use only the mesh: export it "
     "from the other program to a Gmsh file (.msh) and read it with sagefe convert."},
    {"S107", "another layout reads the deck without mistakes",
     "The deck has mistakes under the layout that was used, and none under another layout. It was probably "
     "written for the program with that other layout.",
     "Run the deck again with --layout and the name in the message."},
    {"S108", "the deck was read with the standard layout",
     "sagefe did not recognise the layout of another program, so it read the deck as sage1, its own layout, "
     "and found mistakes. Either the deck has mistakes, or it has another layout.",
     "If the deck was made for sage1, correct the cards that the other messages show. Otherwise name its "
     "layout with --layout."},
    {"S109", "more messages of the same kind",
     "sagefe shows only the first messages of a kind. One wrong count or one shifted column often causes "
     "hundreds of them.",
     "Correct the first one and check the deck again. The others often disappear with it."},
    {"S110", "a card is missing",
     "The layout expects a card here. Instead, the next card is of another kind or closes the deck, or the "
     "file ends. Most often a count on the control card, or before a list, is larger than the number of cards "
     "that follow. A card may also have been lost when the deck was edited.",
     "Compare the count that the message names with the cards. The command sagefe echo DECK shows each card as "
     "it was read. Then correct the count or add the card."},
    {"S111", "a count and its cards do not agree",
     "The values of a card look like those of another kind of card. Either the count that announces this kind "
     "is too large or too small, or a card has too few or too many lines.",
     "Count the cards of the kind in the message and correct the count that it names. If that count is right, "
     "an earlier count is wrong. In this case correct the mistake of the first message first."},
    {"S112", "a card has no place here",
     "sagefe knows the name of the card, but the card is not allowed at this point of the deck. Or the deck "
     "was already complete before this card.",
     "Move the card to the position that docs/manual/deck_format.md (or the layout) gives, or remove it."},
    {"S113", "lines behind the end of the deck",
     "sagefe read all cards that the counts announce, and ignored the lines that follow. Notes by the author "
     "of the deck are harmless there. Cards there have no effect.",
     "If the lines are cards, one of the counts in the deck is too small. If they are notes, nothing needs to "
     "be done."},
    {"S114", "the last card is not marked as the last",
     "In this layout the last card of a list has a mark, such as a negative number. The list ended without "
     "this mark.",
     "Add the mark to the last card of the list, or add the cards that are missing behind it."},
    {"S115", "a value is missing",
     "A required field is blank, or the line ends before it. On a fixed-format card, a value that is a few "
     "columns too far left or right lies in another field.",
     "Write the value into the columns that are marked below the card in the message. The command sagefe echo "
     "DECK shows what every field holds."},
    {"S116", "a card lacks its fixed word or number",
     "The layout requires a fixed word or number here, which distinguishes this card from others. If the field "
     "holds anything else, a card is missing or repeated, or the deck has another layout.",
     "Check the cards before this one first, since a wrong count shifts all cards that follow. Then correct "
     "the word."},
    {"S117", "a code is unknown",
     "The field holds a code number or word that the layout does not have. It is a typing error, or an option "
     "of the original program that sagefe does not have.",
     "Use one of the codes that the message lists. If the layout is yours, add the code to the map of this "
     "field (legacy_inputs/layouts/README.md)."},
    {"S118", "a value is not allowed",
     "The field accepts only certain values, or values between limits. The usual reasons are a misplaced "
     "decimal point and a value in the columns of its neighbour.",
     "Correct the value. The message gives the allowed values, in the units of the deck."},
    {"S119", "numbers that are not read",
     "A card without fixed columns (read by Fortran's list-directed READ) has more values than sagefe reads "
     "from it, or numbers follow behind the last card. Either a value too many was written, or a count before "
     "them is too small, or the deck belongs to another program. In the last two cases values are lost that "
     "should be used.",
     "Correct the count or the values. If numbers are left over on purpose, as remarks, end the values with a "
     "slash (/)."},
    {"S120", "a field is no number",
     "The columns of a number contain a character that no number has: a letter O in place of a zero, a second "
     "point, a comma, or a part of the neighbouring field. A tab shifts everything behind it.",
     "The marks ^ below the card in the message show the columns. Correct the value or move it into its "
     "columns. Replace tabs by blanks."},
    {"S121", "a number is not finite",
     "The field holds NaN, Inf or a number beyond 1e308. Such numbers come from a spreadsheet or a program "
     "that divided by zero.",
     "Correct the value where the deck was made."},
    {"S122", "a blank inside a number",
     "A blank separates the digits of one number. Depending on the layout, sagefe skips the blank or reads it "
     "as zero, as Fortran does: 1 5 becomes 15 or 105. Most often the card is shifted by one column, so that "
     "one number spreads over two fields.",
     "Move the values into their columns. If the number is right as it was read, write it without the blank."},
    {"S123", "a comma ends a field",
     "On a fixed-format card a comma ends the field early. The next field then starts right behind the comma, "
     "not at its own columns.",
     "Remove the comma, or separate all values of the card by commas."},
    {"S124", "a number in an unusual form",
     "The number has the exponent letter Q, which only some compilers accept, or the field has only a sign or "
     "a point, which reads as 0. The message gives the value that was read.",
     "Write the number with E or D, or write 0 if zero is meant."},
    {"S125", "blanks count as zeros",
     "In this layout blanks inside a numeric field are zeros (Fortran's BZ). For example, 15 with two blanks "
     "behind it in a field of four reads as 1500. An editor that removes blanks at the end of a line changes "
     "such a deck.",
     "Align integers at the right end of their fields and write real numbers with a point."},
    {"S126", "the FORMAT of a field sets the decimals",
     "In a field with a Fortran FORMAT such as F10.3, the last three digits of a number without a point are "
     "decimals: 12345 reads as 12.345. Old decks often rely on this rule; new ones rarely do.",
     "Write the decimal point. If the number is right as it was read, nothing needs to be done."},
    {"S127", "a blank field has its default value",
     "The field is blank, so sagefe uses its default. It reports this if other cards of the same kind have a "
     "value there, or if the layout requests the note.",
     "If the default is not what you mean, write the value."},
    {"S128", "a value crosses the boundary between two fields",
     "There are digits on both sides of the boundary between two fields, or behind the last field. The card is "
     "probably shifted by some columns, and sagefe read only a part of the intended number.",
     "Move the values into their columns. The command sagefe echo DECK shows the fields under a ruler."},
    {"S129", "characters beyond the last field are ignored",
     "sagefe does not read text behind the last field of a card or beyond the last column of the layout. Old "
     "decks often have remarks there.",
     "If the text is a remark, nothing needs to be done. If it is a value, move it into its columns."},
    {"S130", "a sequence number is read as data",
     "Old decks have the sequence numbers of punched cards in columns 73-80. The fields of this card extend "
     "into those columns, so that the sequence number is read as data.",
     "Remove the sequence numbers, or set sequence_columns of the layout to the columns that contain them in "
     "the deck."},
    {"S131", "a value that the layout computes is invalid",
     "The layout computes a value from other fields by an expression. The result is not a number (a division "
     "by zero, a root of a negative number), or it is not an integer where an integer is needed. The author of "
     "the layout did not foresee the values on these cards.",
     "Check the values of the fields in the expression. The command sagefe layout check LAYOUT DECK shows "
     "them. Then correct the card or the expression."},
    {"S132", "reading stopped here",
     "After this mistake all following cards would be misread. sagefe stops here, because every further "
     "message would be meaningless.",
     "Correct the mistake that was reported before, then check the deck again."},
    {"S133", "a name or title runs into the next field",
     "The text is longer than its field. The numeric field behind it reads the rest of the text.",
     "Shorten the text so that it ends within its field."},
    {"S134", "numbers behind the last field",
     "The card has more numbers than fields, and the last numbers are not read. The card has a value too many, "
     "is shifted, or belongs to the layout of another program.",
     "Remove the numbers or move them into their fields. A remark behind the last field must begin with a "
     "word, not with a number."},
    {"S140", "there is no layout of this name",
     "--layout accepts the name of a built-in layout or the path of a layout file. sagefe found neither.",
     "Use a name from the list in the message, or check the path."},
    {"S141", "a layout file is not valid TOML",
     "The file breaks the rules of TOML: a bracket or quote is not closed, a key occurs twice, or a text is "
     "not in quotes.",
     "Correct the line in the message. Write FORMATs and expressions as texts in quotes. "
     "legacy_inputs/layouts/README.md shows every kind of line."},
    {"S142", "a FORMAT of a layout is wrong",
     "The FORMAT of a card breaks the rules of Fortran, or it does not agree with the fields that the card "
     "lists. Each name in the list fields needs one edit descriptor of its kind: I for an integer, F or E for "
     "a real number, A for text.",
     "Correct the FORMAT at the character in the message, or correct the list of fields. A repetition such as "
     "8F10.0 counts as eight fields."},
    {"S143", "an entry of a layout is wrong",
     "A key of the layout is unknown, is missing, or has a value of another kind. Or two entries contradict "
     "each other. sagefe rejects unknown keys, because a typing error would otherwise change how the deck is "
     "read.",
     "Correct the entry on the line in the message. legacy_inputs/layouts/README.md lists all keys with "
     "their values."},
    {"S146", "an expression of a layout is wrong",
     "A count, a condition or a value is an expression of fields of earlier cards. This one can't be read, "
     "uses a name that no earlier card has, or gives a text where a number is needed.",
     "Correct the expression. Write values as CARD.FIELD, texts in single quotes, and use the functions of "
     "legacy_inputs/layouts/README.md."},
    {"S147", "a name of a layout has no meaning for the model",
     "sagefe builds the model from the names of cards and fields. Either it does not know this name, so that "
     "the values would be lost, or a card or field that every model needs is missing.",
     "Correct the name (the message proposes similar ones), or rename it with as = \"...\". Mark a card or "
     "field that is not needed with ignored = true."},
    {"S148", "a draft of a layout can't be used to compute",
     "The command sagefe layout guess writes drafts, whose names and codes are guesses. sagefe can display a "
     "deck with a draft, but does not compute with guesses.",
     "Complete the layout (docs/manual/layout_guess.md), then remove the line draft = true from it."},
    {"S149", "the names of deck and layout are exchanged",
     "sagefe layout check expects the layout first, then the deck.", "Exchange the two names."},
    {"S150", "a model file is not valid TOML",
     "The text breaks the rules of TOML at this position: a quote or bracket is not closed, a key occurs "
     "twice, or a value has a form that TOML does not allow.",
     "Correct the line. https://toml.io explains the format on one page, and docs/manual/model_file.md lists "
     "what a model file contains."},
    {"S151", "a model file has an unknown key",
     "The table has no key of this name. Its keys are the names of the fields of a card. For a material they "
     "are also the parameters of its law.",
     "Use one of the keys that the message lists. docs/manual/model_file.md explains each."},
    {"S152", "a value of a model file is of another kind",
     "The key needs a value of one kind: a number, a text in quotes, true or false, a list in brackets, or a "
     "table. The file gives a value of another kind.",
     "Write the kind of value that the message names. docs/manual/model_file.md has an example of every kind."},
    {"S153", "a name in a model file is unknown",
     "No law, element, formulation, solver, material, group or choice has this name. Or several have it, so "
     "that the name is ambiguous.",
     "Use one of the names in the message. The command sagefe list shows laws, elements and solvers."},
    {"S154", "a unit of a model file does not fit",
     "sagefe does not know the unit of the number, or the unit is one of another quantity, such as a length in "
     "place of a stress.",
     "Write a unit of the right kind, such as \"50 MPa\" for a stress. A number without a unit is in the units "
     "of the model."},
    {"S155", "a model file lacks a key or a table",
     "A table lacks a required key, or the model lacks a required table.",
     "Add the key or table that the message names; docs/manual/model_file.md explains it."},

    // S2: what the cards say together, until there is a model.
    {"S201", "a node is not defined",
     "A card names a node that does not exist: no node card has its number, and no line or block generates it. "
     "If a step of the generation is wrong by one, the numbers have gaps.",
     "Correct the number, or correct the generation that should make the node. The command sagefe echo DECK "
     "shows how each card was read."},
    {"S202", "an element is not defined",
     "A card (pressure, removal, strength) names an element that does not exist: no element card has its "
     "number, and no block generates it.",
     "Correct the number or the block. The element numbers of a block run along its rows."},
    {"S203", "a group is not defined",
     "A card names a group that no group card defines. The lists of a stage (activate, remove) and the initial "
     "stress cards need group numbers, not element numbers.",
     "Correct the number or add the group card."},
    {"S204", "a material is not defined", "A group names a material number that no material card has.",
     "Correct the material number on the group card, or add the material."},
    {"S205", "a number is given twice",
     "Two nodes, elements, groups or materials have the same number, so that the second would replace the "
     "first. Often a block and a single card overlap.",
     "Give one of them another number, or remove the card that is not needed."},
    {"S206", "a number is out of range",
     "Nodes, elements, groups and materials have numbers from 1 upwards. A zero or negative number comes from "
     "a blank field or a shifted card. A block must not generate numbers above the largest number that sagefe "
     "allows.",
     "Give a number of 1 or more."},
    {"S207", "a value must not be negative",
     "Counts, steps, spacing ratios, areas and limits are zero or positive. Zero or blank often means the "
     "default.",
     "Correct the sign or the columns. A direction is not given by the sign of such a value but by a field of "
     "its own: docs/manual/deck_format.md."},
    {"S208", "a value is too large to compute with",
     "Numbers beyond 1e100 overflow when they are squared. No length, force or stiffness of soil comes near "
     "that. Some programs use such a number as a mark for \"no value\".",
     "Correct the value. For \"very stiff\" use a modulus 1e3 to 1e6 times that of the neighbours."},
    {"S209", "a range of numbers does not end at its last number",
     "First, last and step must lead exactly from the first to the last number. From 1, steps of 3 reach 10; "
     "steps of 4 do not.",
     "Correct the last number or the step. If the last number is blank, the range has only the first number."},
    {"S210", "a code on a card is unknown",
     "A code chooses among alternatives, such as geometry, coordinate system, support, kind of report, method "
     "or formulation. The number on the card is the code of none of them.",
     "Use one of the codes in the message; docs/manual/deck_format.md explains each."},
    {"S211", "an element type is unknown", "The group card has an element code that sagefe does not have.",
     "The command sagefe list elements shows codes and formulations. An element of your own needs a plug-in "
     "(docs/manual/plugins.md) or a program of your own."},
    {"S212", "a material law is unknown", "The material card has the code of a law that sagefe does not have.",
     "The command sagefe list materials shows codes and parameters."},
    {"S213", "a solver is unknown",
     "The control card or --solver names a solver that does not exist in this build of sagefe. Some solvers "
     "need additional libraries.",
     "Solver 0 (automatic) always works. The command sagefe list solvers shows the others."},
    {"S214", "the deck lacks something that every model needs",
     "The deck has no nodes, elements, groups or stages. A count on the control card is zero or blank, or the "
     "cards have another name.",
     "Add the cards and their counts. The command sagefe echo DECK shows how each card was read."},
    {"S215", "the totals do not match",
     "The control card gives a total number of nodes or elements, and the cards define another number. A "
     "difference is an error, because it reveals lost cards and wrong generation.",
     "Find the card that is missing or that generates too much, or correct the total. A total of zero is not "
     "checked."},
    {"S216", "an element names a node twice",
     "Two corners of one element are the same node. Only a quadrilateral of 4 nodes may have that: it becomes "
     "a triangle. In an interface element, each pair consists of two different nodes at the same place.",
     "Correct the node number. Give each side of an interface its own nodes."},
    {"S217", "an element has the wrong number of nodes",
     "The card gives more or fewer nodes than the element type has, or leaves a corner blank. If all mid-side "
     "nodes are blank, sagefe makes them.",
     "Give all corners, and either all mid-side nodes or none. Or choose the element type with this number of "
     "nodes on the group card."},
    {"S218", "a generated line or block contradicts itself",
     "The numbers of nodes or elements, the steps and the corners of a line or block contradict each other. "
     "The last number is not reached, a corner is not defined yet, two nodes would get one number, or far too "
     "many nodes would be made.",
     "Check the columns, rows and steps of the card. The number of a node in a block is first + column x "
     "column step + row x row step. Define the corners on cards before the block."},
    {"S219", "a step or count was left blank",
     "Either sagefe read a blank field as 1, or the card gives a step without the last number of its range and "
     "sagefe ignored the step. The message gives the meaning that was used.",
     "If that is meant, nothing needs to be done. Otherwise write the number."},
    {"S220", "a spacing ratio is extreme",
     "The last interval is very many times as long as the first. Neighbouring elements then differ so much in "
     "size that accuracy suffers. Perhaps a length was given in place of a ratio.",
     "Ratios between 0.05 and 20 over a whole line are usual. Use more elements in place of a larger ratio."},
    {"S221", "a parameter of a law is missing", "The law needs this parameter and has no default for it.",
     "Give the parameter on the parameter card, at its place in the order that the layout gives. The command "
     "sagefe list materials also shows the order."},
    {"S222", "a parameter has its default", "The parameter is blank, so sagefe uses its default.",
     "If the default is not meant, write the value."},
    {"S223", "a law does not have a given parameter",
     "The card gives more values than the law has parameters, or a Python or C++ program names a parameter "
     "that the law lacks. Perhaps another law is intended, or a value was inserted twice.",
     "Compare the card with the parameters that the command sagefe list materials shows."},
    {"S224", "a law or element rejects a parameter",
     "The law or element can't compute with the value: a modulus of zero, a Poisson's ratio of 0.5, a friction "
     "angle of 90 degrees, or a dilation angle above the friction angle. Angles are in degrees, stresses in "
     "the deck's units.",
     "Correct the value. For nearly incompressible soil use a Poisson's ratio of up to 0.4999999 with the "
     "element quad4 enhanced (--formulation 5) or with 8-node elements."},
    {"S225", "law and element do not fit",
     "Solid elements need a law for solids, and interface elements a law for interfaces. The material of the "
     "group has a law of the other kind.",
     "Give the group a material of the right kind. The command sagefe list materials shows the kind of each "
     "law."},
    {"S226", "the shape of an element can't be used",
     "The element has no area, is folded, runs clockwise, has a corner of 180 degrees or more, or lies at a "
     "negative radius. Or it is an interface, and the two nodes of a pair are at different places. The "
     "stiffness would be negative or infinite.",
     "List the nodes counter-clockwise in the order that the message gives, or correct the wrong coordinate. "
     "In an interface, nodes 1-2 run along one side and nodes 3-4 back along the other. In axisymmetry x is "
     "the radius."},
    {"S227", "elements are badly distorted",
     "sagefe can compute with the element, but the stresses in it are inaccurate. Its angles are far from 90 "
     "degrees (60 in triangles), or its sides have very different lengths.",
     "Move the nodes, or use smaller elements where the mesh changes its direction. 8-node elements tolerate "
     "distortion better than 4-node elements. Distorted elements do no harm if they are far from the places "
     "whose results you use."},
    {"S228", "a title or name has characters that can't be printed",
     "The text has control characters or bytes that are not UTF-8. The outputs show ? in their place. The "
     "computation does not change.",
     "Write the name in ASCII or UTF-8."},
    {"S229", "the deck needs something that sagefe does not compute",
     "The deck has cards for something that sagefe lacks or does not translate from this program. The message "
     "names it. Without these cards the results would be those of another problem.",
     "Remove these cards if your problem does not need them. Or use --partial: sagefe then computes the rest, "
     "and every result lists what is missing."},
    {"S230", "there is no such edge",
     "A pressure card names two nodes, or an element and an edge number, but no solid element has this edge. "
     "Or the edge lies between two elements and the card does not choose one of them.",
     "Give the two end nodes of one element edge on each card; a longer line needs one card per edge. Give the "
     "element if two elements share the edge."},
    {"S231", "an edge is listed in the wrong direction",
     "The layout defines the direction in which edges run around their elements. This edge runs in the "
     "opposite direction, so that its pressure would have the wrong sign.",
     "Exchange the nodes of the card. Or give the edge card of the layout a field sense: its value 3 allows "
     "both directions."},
    {"S232", "the nodes of an edge do not fit its load",
     "The card has a value for a third node but no third node, or its middle node is not that of the edge.",
     "Give all three nodes of a quadratic edge in their order, or leave the third value blank."},
    {"S233", "a support card contradicts itself",
     "The card has a displacement without code 1 (fixed), a nonzero displacement before the first stage, or a "
     "release (-1) outside of a stage. Supports can be moved and released only in a stage.",
     "Put prescribed displacements and releases on the fixity cards of a stage, with code 1 or -1."},
    {"S234", "a support card has no effect or uses a default",
     "Both codes are 0 or blank, so that the card has no effect. Or a displacement is blank, and sagefe holds "
     "the node where it is.",
     "Give the code (1 fixed, -1 released), or remove the card."},
    {"S235", "the unknown does not exist at this node",
     "The card names an unknown, such as rotation or pore pressure, that no element at this node solves for. "
     "Or it gives two components of an unknown that has one.",
     "Use a name from the list in the message, or give the node an element that solves for this unknown."},
    {"S236", "an initial stress or history card does not fit",
     "The kind of the card does not suit the elements of its group. Kinds 1 (geostatic) and 8 (at rest) are "
     "for solids, and kind 3 (traction of the neighbours) is for interfaces. Or a quantity is given twice or "
     "does not exist. Or the law can't start from the given state.",
     "Choose the kind for the group and give the values in their order: docs/manual/deck_format.md, card "
     "initial. The command sagefe list materials gives the number of history variables of each law."},
    {"S237", "values of an initial stress card are blank or not used",
     "sagefe reads blank stress components as 0, and ignores values that this kind of card does not use. Often "
     "such values were meant for another kind of card.",
     "Compare the card with docs/manual/deck_format.md, card initial. If a component is zero, write the zero."},
    {"S238", "a number of the stage card is out of range",
     "A stage needs at least 1 increment, a tolerance between 0 and 1 (blank means 1e-8) and a time that is "
     "not negative.",
     "Correct the field that the message names."},
    {"S239", "activations and removals contradict each other",
     "A group is activated twice, or is removed before or in the stage of its activation. Or an element is "
     "removed twice. A removed group can't return, because its history is lost.",
     "Correct the stages. To place a body again, use another group with the same nodes and its own material."},
    {"S240", "the increments card does not fit the stage",
     "A card gives load factors, but the stage has no load. Or it gives displacements of the increments, but "
     "no displacement card names the nodes. Or a card has both load factors and displacements, or the "
     "displacement is given on neither card.",
     "Give each increments card either load factors or displacements, and add the card with the load or "
     "displacement that they multiply."},
    {"S241", "strength factors can't be used here",
     "Strength factors multiply the strength of a material. They need a deck with one step of loading, no "
     "initial stress, and a material with a strength. Each factor must be above 0.",
     "Correct the factor. Otherwise reduce the strength on the material card and run the deck twice, or use "
     "sagefe safety, which finds the factor of any deck."},
    {"S242", "a report card lacks something",
     "A report needs the data of its kind: a height for a triaxial specimen, a point card for a point or a "
     "cut, a "
     "stage that exists, and an area if the nodes do not define it.",
     "Complete the card: docs/manual/deck_format.md, cards report and point."},
    {"S243", "a point lies outside the mesh",
     "No solid element of the mesh, or of the chosen group, contains the point. The usual reasons are units "
     "(mm for m) and exchanged coordinates.",
     "Correct the coordinates or the group. A point on the boundary of the mesh counts as inside."},
    {"S244", "a node on the axis can't be moved radially",
     "At r = 0 the radial displacement is zero by symmetry. A prescribed value or a release would open a hole "
     "in the body.",
     "Remove the radial code (x) of that node. Or check whether the model should be in plane strain (geometry "
     "1)."},
    {"S245", "the start stress can't be computed",
     "sagefe computes the start stress from the weight of the ground only if that stress is in equilibrium by "
     "itself. It needs horizontal layers with one unit weight each, K0 of every material, a level at or above "
     "the ground, and no interfaces in the ground.",
     "Give what is missing. For other ground use a first stage with a gravity card, or initial cards for each "
     "group (kind 1 for ground, kind 3 for interfaces)."},
    {"S246", "the start stress lacks forces that balance it",
     "The start stress is in equilibrium only with forces that the deck does not state. Either free edges "
     "carry the start stress, and sagefe adds the pressures that balance it there. Or K0 differs along one "
     "level, and the ground moves in the first increment. The message gives the place.",
     "If sagefe added pressures, check that something supports these edges in reality. If K0 differs, give one "
     "value for each level, or let a gravity stage find the stresses."},
    {"S247", "p_a or gamma_w is missing",
     "The law uses the atmospheric pressure or the unit weight of water. Decks have no built-in units, so "
     "sagefe can't supply them.",
     "Give the value on the control or unit card. p_a is 101.325 kPa or 14.696 psi, and gamma_w is 9.81 kN/m3 "
     "or 0.036111 lb/in^3."},
    {"S248", "a water card does not fit",
     "The card lacks what its kind needs (points of a line, pairs of node and pressure, r_u, a bulk modulus of "
     "water), or has numbers that its kind does not use. Or it names a stage that does not exist or a group "
     "without solids. Or the card needs heads, and no element solves for heads.",
     "Complete the card: docs/manual/deck_format.md, card water. docs/manual/water.md has examples."},
    {"S249", "an undrained group has a given pore pressure",
     "The pore pressure of an undrained group follows from its change of volume. A water card that gives the "
     "pressure in the same stage contradicts that.",
     "Give the pressure in an earlier stage, or first make the group drained by a water card of kind 6."},
    {"S250", "heads of an earlier run can't be used",
     "A water card of kind 7 reads heads from the result file of another run. That file is missing, is not "
     "from sagefe, or has no heads, no such stage or no equilibrium in that stage. Or its unit of length or "
     "its geometry differs, or nodes of this deck lie outside of its mesh.",
     "Run the deck of the flow with --result. On the card, name its STEM.h5 relative to the folder of this "
     "deck. The mesh of the flow must contain all solids that the card concerns."},
    {"S251", "a mesh lies in another plane",
     "A two-dimensional model lies in the x-y plane. The nodes of this mesh have different heights z: it was "
     "drawn in the x-z or y-z plane, or it is a surface in space.",
     "Draw the geometry at one z, with y upwards. Or rotate it in the program that made the mesh (Gmsh: "
     "Rotate)."},
    {"S252", "a surface belongs to two groups",
     "Each surface of a mesh becomes part of one element group with one material. This surface has two names.",
     "Give the surface only one physical group. In an .inp file, name the sets of the groups by *SOLID "
     "SECTION. Curves may belong to several groups."},
    {"S253", "an element can't replace that of the deck",
     "--element and --element-b replace quadrilaterals by elements with at least as many nodes, and make the "
     "mid-side nodes that the cards lack. They can't replace an element by one with fewer nodes, and they do "
     "not change triangles.",
     "Choose an element with enough nodes (sagefe list elements), or write the deck with 4-node "
     "quadrilaterals."},
    {"S254", "the data of a section are incomplete",
     "A point, line or area of a drawn section lacks something. An index names no point or line, a line has "
     "too few points, the ends of an arc have different distances from its centre, or a size is negative.",
     "Complete or correct the item that the message names."},
    {"S255", "an outline encloses no area",
     "The outline of an area or of its hole crosses or touches itself or encloses nothing, or the hole extends "
     "beyond the outline. Inside and outside are then undefined.",
     "List the corners in their order around the area. Divide an area that touches itself into two."},
    {"S256", "areas of a section overlap",
     "Two areas contain the same ground. Each place belongs to one area with one material.",
     "Let the areas share an edge, or give the larger one a hole for the smaller one."},
    {"S257", "a line of a section lies outside of all areas",
     "A line without a beam needs an area on at least one side, and an interface needs areas on both sides. A "
     "line with a beam may extend beyond the ground, but must touch it.",
     "Correct the points of the line, or extend the outline of the area to it."},
    {"S258", "two lines with a beam or interfaces coincide",
     "At each place of a section, one line can have a beam, and interface elements on one or both of its "
     "sides. Here two such lines lie on each other.",
     "Let one of the lines end where the other begins, or remove the beam or the interfaces of one."},
    {"S259", "this section needs Gmsh",
     "Gmsh, which makes meshes of general areas, can't be loaded. Without it sagefe can mesh two kinds of "
     "sections: areas of four sides whose opposite sides have equally many pieces, and sections whose lines "
     "are all horizontal or vertical.",
     "Install Gmsh's library (Debian: libgmsh4.8), or give the path of its file in the environment variable "
     "SAGEFE_GMSH. Or divide the area into blocks of four sides."},
    {"S260", "no strength to reduce for a safety factor",
     "sagefe safety divides the strengths of the chosen groups by a factor. Either the deck has no such stage "
     "or group, or no chosen group has a law with a strength. Elastic laws have none. Strengths of interfaces "
     "(joints), anchors and walls are divided only if --reduce names them. In a law of your own, the roles of "
     "its parameters declare which of them are strengths.",
     "Correct --stage or --group, name more parts in --reduce, or give the soil a law with a strength (sagefe "
     "list materials)."},
    {"S261", "Gmsh can't mesh an area",
     "Gmsh reported an error, left a part of the area empty, or put elements across a line. The usual causes "
     "are lines that almost touch or that meet at a very small angle.",
     "Let lines that almost meet share a point, or choose smaller sizes around them."},
    {"S262", "the sizes give too many elements",
     "Sizes are lengths of element edges in the unit of the coordinates. Half the size makes four times as "
     "many elements.",
     "Choose larger sizes, or use small sizes only at the points and lines that need them."},
    {"S263", "an element of a meshed section is turned inside out",
     "An arc becomes straight edges between nodes on the arc. If another line is closer than the arc bulges, "
     "an element between them loses its area.",
     "Choose smaller sizes along the arc, or move the other line."},

    // S3: a legal model that may not be meant.
    {"S301", "p_a or gamma_w does not fit the units",
     "In the units that the deck names, the atmospheric pressure or the unit weight of water has another "
     "value. Moduli of hyperbolic laws and stiffnesses of interfaces are proportional to these numbers.",
     "Correct the value, or the names of the units."},
    {"S302", "the units do not belong together",
     "The unit of stress is not the unit of force divided by the square of the unit of length. An example is "
     "kN and mm together with kPa. Loads, weights and moduli then differ by powers of ten.",
     "Use a consistent set: kN, m, kPa; N, mm, MPa; lbf, in, psi; kip, ft, ksf."},
    {"S303", "an initial stress is implausible",
     "The card has K0 outside 0.3 to 3, tension, a ground level far from the mesh, a negative weight, or a "
     "stress above the modulus of the material. Initial stresses are positive in compression.",
     "Check sign, unit and level. Soil at rest is hardly ever in tension."},
    {"S304", "elements are very long and thin",
     "Elements are more than 10000 times as long as wide. Most often a coordinate lost its decimal point, or a "
     "layer was meant to be an interface.",
     "Correct the coordinate. If a thin zone is intended, model it by interface elements of zero thickness."},
    {"S305", "element numbers have a gap",
     "The numbers are not consecutive. A block may be shorter than intended, so that a part of the body is "
     "missing.",
     "Look at the mesh: the command sagefe run DECK --picture displacement draws it. If the gap is intended, "
     "nothing needs to be done."},
    {"S306", "a material parameter is implausible",
     "The parameter is a negative Poisson's ratio or unit weight, a strength above the modulus, or a friction "
     "angle that may be in radians. The law can compute with it, but few soils have such values.",
     "Check the unit and the column. Angles are in degrees."},
    {"S307", "a displacement is larger than the mesh",
     "A prescribed displacement is larger than the whole body. Most often its unit is wrong (mm for m). An "
     "analysis with small strains can't describe so large a displacement.",
     "Correct the value, or the unit of the coordinates."},
    {"S308", "a load is implausibly large",
     "The force would strain the whole mesh by more than 1 (100 %), or the pressure is larger than the largest "
     "modulus.",
     "Check the units of loads and moduli. In axisymmetry a nodal force is that of the full circle."},
    {"S309", "a release of a direction without a support",
     "Code -1 removes a support, and this node has no support in this direction.",
     "Correct the node or the direction, or remove the card."},
    {"S310", "a pressure acts in an unusual way",
     "The pressure pulls, acts on an edge inside the body that two elements share, or acts on one side of an "
     "interface only. All are possible, but rarely intended.",
     "Check the sign and the nodes: a positive pressure pushes into the element. Apply it to the surface that "
     "exists in that stage."},
    {"S311", "gravity acts in an unusual way",
     "Gravity is a factor on unit weights. The factor of a stage is added to the factors of earlier stages. "
     "The usual value is -1 in y, in one stage only. sagefe reports factors above 3 (9.81 is the acceleration "
     "in m/s^2), an upward or radial direction, and a second gravity. Models of a centrifuge, up to about 3 m "
     "high, may have 15 to 500.",
     "Give gravity_y = -1 in one stage and 0 in stages that do not change gravity."},
    {"S312", "gravity and unit weights do not fit",
     "Gravity acts, but no material has a unit weight, or one unit weight is blank. Or the weight of a column "
     "as high as the mesh is more than the modulus.",
     "Give unit weights in force per volume of the deck's units (18 kN/m^3, 0.065 lb/in^3). Write 0 for a "
     "weightless body."},
    {"S313", "a stage has very many increments",
     "The time of a run is proportional to the number of its increments.",
     "Fewer increments often give the same result: compare with half as many. Elastic bodies need only one "
     "increment."},
    {"S314", "the tolerance is loose",
     "With this tolerance a state counts as equilibrium although a large part of the forces is unbalanced. "
     "Reports and limit loads have errors of about that size.",
     "Leave the field blank, which means 1e-8, or give a tolerance of up to 1e-4."},
    {"S315", "an initial stress is replaced",
     "Two initial cards of one stage concern the same group. sagefe uses the later card.",
     "Remove one of them."},
    {"S316", "a stage adds nothing",
     "The stage has no load, displacement, gravity, activation or removal, or the first stage has water but no "
     "weight. A stage without loads only releases unbalanced forces, which is useful after an initial stress. "
     "Otherwise the cards of this stage may have ended up in another stage.",
     "Check the order of the cards, or remove the stage."},
    {"S317", "a report's numbers do not fit the mesh",
     "The height, area or cell pressure on the report card is very different from the mesh or the moduli. "
     "sagefe divides the displacement by this height and the force by this area.",
     "Give the height and area that were modelled. If only a quarter of a specimen is meshed, give those of "
     "the whole specimen (docs/manual/deck_format.md)."},
    {"S318", "a point lies between groups, or in no active element",
     "The point lies where groups meet. Stresses jump there, and sagefe uses the group that the message names. "
     "Or no element that contains the point is active when the report starts.",
     "Give the group of the point on the report, or move the point away from the boundary. Check which groups "
     "the stages activate and remove."},
    {"S319", "a straight side is held in part",
     "Most nodes of a side have a support in one direction, but some have none. Often a node on a line of "
     "symmetry was forgotten, or the last number of a range is wrong.",
     "Hold all nodes of a line of symmetry. If nodes are free on purpose (beside a footing or platen), nothing "
     "needs to be done."},
    {"S320", "two cards of a stage contradict each other",
     "In one stage a node has two displacements, or is both held and released. Most often the node is a corner "
     "where two lines with different cards meet. sagefe uses the last card.",
     "Keep one card for the node, or give the intended value on the last card."},
    {"S321", "a load on the axis has no effect",
     "At r = 0 a radial force has no effect, and an edge on the axis has no area.",
     "Remove the load, or check whether plane strain (geometry 1) is meant."},
    {"S322", "no element is active in a stage",
     "Every group has been removed or is not activated yet, so the model is empty.",
     "Correct which groups this stage or an earlier one activates and removes."},
    {"S323", "nothing holds the mesh",
     "A part of the body can move without strain, either as a whole along x or y, or by rotation. The "
     "stiffness matrix is then singular. Parts that touch without common nodes or an active interface are "
     "separate bodies. The message names interface groups beside the part that are not active in the stage.",
     "Add at least two fixities in one direction and one in the other. In axisymmetry one along the axis is "
     "enough. Join parts by common nodes or interfaces. Activate interfaces in the same stage as the structure "
     "or the ground that they connect."},
    {"S324", "the solver is for symmetric matrices only",
     "Non-associated plastic flow (dilation differs from friction) and interfaces with friction have an "
     "unsymmetric tangent. A symmetric solver would converge slowly or not at all.",
     "Use solver 0 (automatic), or an unsymmetric solver from the list that sagefe list solvers prints."},
    {"S325", "elements lock near a Poisson's ratio of 1/2",
     "Fully integrated 4-node elements of nearly incompressible material are too stiff, and their stresses "
     "oscillate from element to element.",
     "Use --formulation 5 (enhanced) or 8-node elements (--element quad8). The command sagefe compare DECK "
     "--formulation-b 5 shows the difference."},
    {"S326", "elements overlap",
     "Two elements cover the same ground, so that its stiffness and weight count twice. A block was given "
     "twice, a node lies beyond its neighbour, or two groups of different stages use the same nodes without "
     "overlay.",
     "Correct the nodes or the block. Give overlay 1 to a group that lies on another one on purpose, such as a "
     "reinforced zone or a body that is placed again."},
    {"S327", "an interface does not lie between its bodies",
     "The sides of the interface element belong to the wrong bodies, or its nodes are not those of the "
     "neighbouring solids. The normal stress would have the wrong sign.",
     "List nodes 1-2 along the side of the first body and nodes 3-4 back along the other. Each side uses the "
     "nodes of its own solid."},
    {"S328", "nodes on the axis are held",
     "In axisymmetry the radial displacement at r = 0 is zero. These nodes had no radial support, so sagefe "
     "added one.",
     "Nothing needs to be done. If the model should be in plane strain (geometry 1), correct the geometry: "
     "sagefe then adds no supports."},
    {"S329", "nodes or materials are not used",
     "Nodes belong to no element, or no group has this material. sagefe ignores them.",
     "Nothing needs to be done. You may remove the cards. If many nodes are not used, check whether a block of "
     "elements is missing."},
    {"S330", "a node without elements is loaded or displaced",
     "The node belongs to no element in any stage, so that a load or displacement there has no effect.",
     "Correct the node number. Mid-side nodes that sagefe makes have numbers behind those of the deck."},
    {"S331", "a law warns of its parameters",
     "The law can compute with these parameters, but its results may mislead. The message gives the range in "
     "which the law is reliable.",
     "Read the page of the law in docs/theory."},
    {"S332", "a card has no effect in its stage",
     "In this stage the elements of the card are not active, or its nodes belong to no active element. Or "
     "nothing there has the unknown or the quantity of the card. An example is a support for displacements at "
     "nodes of flow elements, which have only a head.",
     "Move the card to the right stage, or correct which groups are active. If the card is for heads, write "
     "the name of that unknown (head) on it."},
    {"S334", "the mesh is coarse for the question",
     "Too few elements lie between two loads or supports, so that the result there is far from that of a fine "
     "mesh. The message gives the approximate error.",
     "Compare with --refine 1, or use --error or --converge (docs/manual/accuracy.md)."},
    {"S335", "interface elements touch no solid",
     "An interface element has no solid on either side, so sagefe can't check which side is which.",
     "If fixities hold its nodes on purpose, nothing needs to be done. Otherwise correct its nodes."},
    {"S336", "bodies meet without being joined",
     "Two nodes at one place belong to separate bodies without an interface between them. The bodies can move "
     "through each other.",
     "Use one node for both bodies, or put an interface element between them. If the bodies are separate on "
     "purpose (a gap), nothing needs to be done."},
    {"S337", "a node lies within a side that does not have it",
     "A node of one element lies on the edge of another element that does not have this node. The mesh opens "
     "or overlaps there when it deforms. Or a beam or bar lies along the side of a solid and does not have the "
     "same nodes, so that the two are not connected between their ends.",
     "Refine the mesh so that whole edges meet, and give structures the nodes of the sides that they lie on. "
     "If the node is in the middle of the edge, use elements with mid-side nodes."},
    {"S338", "nodes are held only by an interface",
     "In this stage one side of an interface has no active solid. Only the stiffness of the interface holds "
     "these nodes, and nothing holds them when it opens.",
     "Activate and remove an interface together with its solid, or hold the nodes by fixities."},
    {"S339", "pore pressure at a free edge is not balanced",
     "The phreatic line lies above edges that nothing supports. Action 1 of its card declares that no free "
     "water lies on them. The pore pressure in the soil then pushes these edges outwards.",
     "Use action 0, with which free water acts on the edges. Or lower the line."},
    {"S340", "pore pressure lifts the soil above",
     "The pore pressure is larger than the weight of the soil and water above, so that the vertical effective "
     "stress is negative. An example is the floor of an excavation over an artesian layer.",
     "Lower the pressure (dewatering), leave more ground, or check the water level and the unit weights."},
    {"S341", "open water beside a wall, but not on the wall",
     "Open water lies on the ground in front of a wall or beside a slab, but does not act on the beams of this "
     "structure. The beams would carry the water pressure from behind without the balancing pressure in front.",
     "Add a water card of kind 1 that names the group of the beams, with the side in value 1 "
     "(docs/manual/water.md). If a pressure card replaces this water, or the side is dry on purpose, nothing "
     "needs to be done."},
    {"S345", "a structure is held only by interfaces",
     "A wall, raft or lining shares no node with solids and has no support, and its interfaces carry no "
     "tension. Only pressure and friction hold it. If the interfaces are on one side only, the structure can "
     "lift off.",
     "If weight or pressure acts from the first increment on, nothing needs to be done. Otherwise hold a node "
     "(the toe of a wall), give the interfaces tension, or let the structure share nodes with the soil."},
    {"S346", "a beam turns freely",
     "The beam meets the rest of the model in a single node. Solids and bars hold the displacements of that "
     "node, but neither a support nor another beam holds its rotation. The stiffness matrix is then singular.",
     "Hold the rotation of that node by a fixity card with the unknown rotation, continue the beam into the "
     "solid along a side, or use a bar."},
    {"S347", "released ends meet at a node",
     "A beam end that is released along or across its line has an additional unknown at the node, in the "
     "direction of the release. Two such ends at one node would share that unknown.",
     "List the nodes of one beam in the other order, so that its released end is at its other node."},
    {"S348", "an interface that slips follows a polygon",
     "Interface elements with two pairs of nodes approximate a curve, such as the outside of a pipe. A node "
     "that slides along one chord opens or closes the next, so that a smooth pipe acts as if it were bonded. "
     "Thrust and moment are then those of a bonded pipe.",
     "Use interface6 with quad8 and beam3, with the mid-side nodes on the curve (docs/manual/structures.md). "
     "If the interface does not slip under the loads of the deck, nothing needs to be done."},
    {"S349", "an interface beside undrained soil carries its water pressure",
     "If the pore pressure is given, the traction of an interface is effective. The excess pressure of an "
     "undrained group is not given but follows from its change of volume, and is not subtracted. The traction "
     "is then the total one, and friction acts on water and grains together.",
     "Give the interface friction 0 and the undrained adhesion as cohesion. If the interface is elastic, "
     "nothing needs to be done."},
    {"S350", "the weight of a plate is its unit weight times its thickness",
     "The unit weight of the law plate is a force per volume, as that of soil: 25 kN/m^3 and 0.5 m give 12.5 "
     "kN/m^2. Earlier versions used the unit weight itself as the weight per area.",
     "If the card gives a force per volume, nothing needs to be done. In a deck for an earlier version, divide "
     "the number by the thickness. Other laws of beams and bars have other units of weight: "
     "docs/manual/structures.md has a table."},
    {"S351", "prestress that a structure can't carry",
     "The law of the bars or beams does not allow the force of the initial card. The card gives compression to "
     "an anchor that carries only tension, tension to a strut that carries only compression, or more than the "
     "strength.",
     "The values of an initial card are positive in compression and per unit width: for anchors with a tension "
     "of 150 at a spacing of 2.5, give -60 (-150/2.5). On a card for lock-off the value is the force of one "
     "bar, here -150. Change the sign, the size or the law."},
    {"S352", "strips meet on the axis of symmetry",
     "A beam without bending stiffness in the hoop direction represents many strips side by side. On the axis, "
     "where the strips meet, they have no width. If the rotation is held there, as symmetry requires, the "
     "moment grows as 1/r, and its value at the axis depends on the size of the elements.",
     "Give a plate its thickness (law plate), or a section its hoop stiffnesses. If the strips are spokes that "
     "end on a hub, support them at the radius of the hub."},
    {"S355", "4-node elements dilate",
     "A group of 4-node quadrilaterals without an enhanced strain has a law whose plastic flow increases the "
     "volume. These elements can't follow that flow, and they overestimate limit loads and factors of safety. "
     "On a slope of 1:2 with phi = psi = 20 degrees, the factor of safety is 1.52 with b-bar and 1.58 with "
     "full integration. 8-node elements give 1.39, and the correct value is 1.36 to 1.37. With psi = 5 degrees "
     "the error is the same. docs/theory/accuracy.md has the measurement.",
     "Use quad4 enhanced (--formulation 5) or 8-node elements (--element quad8). With a dilation angle of 0 "
     "(sagefe safety --dilation none), factors from b-bar elements are about 3 % too high."},
    {"S356", "a unit weight is not one of soil",
     "The number is less than a quarter or more than 3.5 times the unit weight of water in the deck's units. "
     "For a law without strength, which may be steel, the upper limit is 8.5 times. Probably the number is a "
     "density (kg/m^3, t/m^3), or has the unit of another program.",
     "Give the unit weight in force per volume of the deck's units: 18 to 21 kN/m^3, 115 to 130 lb/ft^3 or "
     "0.066 to 0.075 lb/in^3. If the units card is wrong, correct it."},
    {"S358", "a modulus or cohesion is not one of soil",
     "sagefe compares the number with the atmospheric pressure in the deck's units. It reports a modulus below "
     "0.5 times that pressure and, for a law with strength, a modulus above 100000 times. It reports a "
     "cohesion above 10 times that pressure and, for a law without friction, a cohesion below 0.005 times. "
     "Probably the number is in another unit (Pa, MPa).",
     "Give moduli and strengths in the stress unit of the units card. For rock, concrete or peat the number "
     "can be right. In this case nothing needs to be done."},
    {"S360", "water levels differ between neighbours",
     "Two groups that share edges have different phreatic lines, or one of them has a line and the other is "
     "dry or has r_u or given pressures. No structure or interface lies between them. The pore pressure jumps "
     "at these edges, and the difference acts as a force that no ground water exerts.",
     "Give both groups one line that descends from level to level. Or put the wall or interface that retains "
     "the water between them, or compute the heads by flow elements."},
    {"S361", "a code for pore water is unknown, or no element has pore water",
     "The field pore_water of a stage card is 0 (excess pressures do not change), 1 (undrained: no water "
     "moves) or 2 (consolidation). Codes 1 and 2 need elements that solve for the pressure of pore water.",
     "Correct the code, or use quad8p4, quad9p4 or tri6p3 with a second material pore_flow "
     "(docs/manual/consolidation.md)."},
    {"S362", "theta or grading of a stage is out of range",
     "The fields theta and grading of the stage card control its time steps. The field theta must lie between "
     "0.5 (Crank-Nicolson) and 1 (backward Euler). The field grading, the length of an increment divided by "
     "that of the one before, must lie between 0.01 and 100.",
     "Correct the field. If it is blank, its value is 1."},
    {"S363", "the first step of a consolidation stage is short",
     "Beside a drained node, where a pressure starts to fall, a step below h^2 / (6 theta c) gives excess "
     "pressures that oscillate from node to node. Here h is the size of the quadratic elements, c their "
     "coefficient of consolidation, and theta the field of the stage card (1 if blank). The oscillations "
     "belong to the discrete equations and decay with time.",
     "Make the mesh finer at the drained node, or the first step longer. A grading above 1 makes each step "
     "longer than the one before."},
    {"S364", "excess pressures oscillate",
     "One corner of an element has a higher excess pressure than all corners around it. A neighbouring corner "
     "has a lower one than all around that corner. The difference is more than 1 % of the largest pressure. "
     "Real pressures in soil have no such waves.",
     "Make the mesh finer at drained nodes, or the first steps longer. theta = 1 damps oscillations that theta "
     "= 0.5 keeps."},
    {"S365", "water can't leave",
     "No node in a part of the model has a prescribed excess pressure, so that no water leaves that part. The "
     "pressures there become equal and do not decrease to zero.",
     "If water should leave, prescribe the excess pressure at the nodes where it leaves (unknown "
     "excess_pressure, code 1)."},
    {"S366", "the pore water of a group is defined twice",
     "A water card makes a group undrained or drained, and the elements of the group already solve for the "
     "pressure of their water.",
     "Remove the water card. The field pore_water of each stage defines whether the water of such elements can "
     "move."},
    {"S367", "the angle of a support is not possible",
     "The field angle of a fixity card rotates the directions that the card holds. It lies between -360 and "
     "360 degrees and is possible only for displacements. A support with an angle can't follow a table of "
     "time.",
     "Correct the angle, or leave it blank. Divide a motion that follows a table of time into stages."},
    {"S368", "displacements at a support contradict each other",
     "The cards of this stage hold a node in three or more directions. No displacement of the node agrees with "
     "all their values.",
     "Hold the node in one or two directions, or correct the values of the displacements."},
    {"S369", "inclined supports or ties are not possible here",
     "The command sagefe bounds and the option --coarsen accept only supports along x and y, and no ties. The "
     "option --grade accepts no ties.",
     "Run the model with sagefe run or sagefe safety, or turn its axes so that all supports are along x and "
     "y."},
    {"S370", "a tie is not possible",
     "A tie gives two nodes the same displacement in all stages, so its card must be before the stages. It is "
     "an error if the supports of tied nodes prescribe different displacements, or if a tied node has a "
     "support at an angle.",
     "On the card of the tie give code 3 in x, y or both, and the other node in the field tie. Leave values, "
     "angle, unknown and history blank (docs/manual/supports.md)."},

    {"S371", "a new node between tied nodes is not tied",
     "A new node lies on an edge whose two ends are tied to each other. sagefe ties such a node only if both "
     "ends belong to one rigid cap: more than two tied nodes on a straight line. Otherwise the edge may lead "
     "across a body whose sides repeat, where a tie would be wrong. New nodes between two rigid caps are not "
     "tied either.",
     "If the edge is a part of a rigid cap, tie at least three nodes of the cap. If it leads across a body "
     "whose sides repeat, use at least two elements between these sides."},

    {"S372", "a beam can turn on a line of symmetry",
     "A beam ends on a straight side of the model, at an angle of more than 45 degrees to it. All nodes of "
     "this "
     "side are held across it, and the end of the beam can move along it and turn. If the side is a line of "
     "symmetry, the end cannot turn, because the mirror image of the beam continues it. With a free rotation "
     "the beam has a hinge there, and no bending moment.",
     "Fix the unknown rotation at the node (docs/manual/structures.md). If a hinge is meant, end the beam with "
     "a "
     "hinged element."},

    // S4: refining, grading and mid-side nodes.
    {"S401", "elements of different degree meet",
     "Two elements share an edge. One of them has a node within this edge, and the other does not. The mesh "
     "would open there.",
     "Give both elements the same number of nodes on the edge. --element quad8 changes all quadrilaterals of "
     "the mesh."},
    {"S402", "the mesh can't be refined so far",
     "The refined mesh would have more elements than can be numbered, or its elements have inner nodes that "
     "can't be divided.",
     "Use a smaller number for --refine, use --grade at corners, or use elements of higher degree: "
     "docs/manual/accuracy.md."},
    {"S403", "the mesh can't be graded there",
     "The node of --grade does not exist or is no corner of an element. Or --grade auto found no corner with a "
     "singular stress.",
     "Name a node at the corner of an element, or use --refine without --grade."},
    {"S404", "a support or load does not fit the graded mesh",
     "The support or load belongs to a node that the graded mesh does not have, because grading moves the "
     "nodes between corners.",
     "Use --refine, which keeps all nodes, or load the edge by a pressure card. For load_control choose a "
     "corner of an element."},
    {"S405", "a report loses nodes by grading",
     "Some nodes of the report are not nodes of the graded mesh. The report is the mean over the remaining "
     "nodes.",
     "Use --refine, which keeps all nodes. If the platen is rigid, the mean is the same."},
    {"S406", "a result that does not converge with the mesh",
     "The displacement under a load on one node, and the stress at a singular corner, grow without limit as "
     "the elements become smaller. Such a number has no true value.",
     "Use a pressure over a width. Read stresses at some distance from the corner, or sums such as the force "
     "on a platen."},
    {"S407", "--coarsen found no coarser mesh",
     "No coarser mesh of quadrilaterals has the same bodies, supports and loads.",
     "Nothing needs to be done: the run uses the deck's own mesh."},
    {"S408", "the required accuracy was not reached",
     "--converge refined the mesh up to its limit of unknowns or time, and the reports still change by more "
     "than the tolerance. If there are singular corners, a limit load or a point load, the numbers converge "
     "slowly or not at all.",
     "The last column of the table gives the accuracy of each number. Increase --max-dofs or --max-seconds, "
     "use --grade auto or elements of higher degree, or choose with --follow a number that converges."},
    {"S409", "refining makes a large model",
     "Each --refine divides every element into four. Memory and time grow at least as fast. The message "
     "estimates the memory.",
     "Use --grade at corners, or 8-node elements: both give the same accuracy with far fewer elements."},
    {"S410", "the error of the mesh is not estimated",
     "Elements of the model lock near a Poisson's ratio of 1/2, or where soil is undrained. Their stresses are "
     "smooth but wrong, and --error detects only errors that make stresses rough.",
     "Use elements that do not lock: 8-node quadrilaterals (reduced), quad4 enhanced, or elements of high "
     "degree."},

    // S5: the analysis.
    {"S501", "no equilibrium",
     "sagefe found no state in which the stresses balance the loads, even with very small increments. Most "
     "often the model has reached a limit load: its strength can carry no more. Otherwise the increments are "
     "too large for a strongly nonlinear law, or interfaces open and close in turn.",
     "The message gives the load up to which there is equilibrium, the place that fails, and what to try. If "
     "the model has reached its limit load, this load is the result. To go beyond it, prescribe displacements "
     "in place of loads. Otherwise use more increments, or method 3 (dogleg)."},
    {"S502", "the stiffness matrix is singular",
     "A part of the model can move without any force. It has no support, is held only by open interfaces, has "
     "no stiffness left at collapse, or stiffnesses in the model differ by more than a factor of 1e16. The "
     "message names a node and a direction.",
     "Add supports or interfaces for that part, reduce the stiffness of very stiff bodies, or end the loading "
     "earlier."},
    {"S503", "a law can't start from its initial stress",
     "The law needs another initial state: a hyperbolic law needs compression, and a law with strength needs a "
     "stress within this strength.",
     "Give an initial card with a small confining stress, or a cohesion. sagefe drive and docs/theory show the "
     "range of each law."},
    {"S504", "the solver lost its accuracy or failed",
     "The factorisation is inaccurate, because entries of the matrix grew during elimination or are not "
     "numbers. The usual reasons are stiffnesses that differ by a factor of 1e12 or more, and collapse.",
     "Use another solver (--solver, sagefe list solvers). Make stiff parts and interfaces only 1e3 to 1e6 "
     "times as stiff as the soil."},
    {"S505", "a part of the program can't be loaded",
     "Some solvers and the writer of result files are libraries that sagefe loads when it needs them. One of "
     "them is not installed, or lacks other libraries.",
     "Install the whole program (cmake --install), or the packages that the message names. The built-in "
     "solvers work without them."},
    {"S506", "these kernels are not available",
     "--kernels selects processor instructions that this machine or build lacks.",
     "Omit --kernels: sagefe then uses the fastest kernels that work."},
    {"S507", "a result is not a finite number",
     "sagefe would have written an undefined or infinite number. The numbers of the model are so large or "
     "small that they overflow.",
     "Use units in which stresses and lengths are between 1e-6 and 1e6."},
    {"S508", "there is not enough memory", "The model does not fit into the memory of this machine.",
     "Use fewer elements (--grade in place of --refine), another solver (on large meshes multifrontal needs "
     "less memory than the profile solver), or a larger machine."},
    {"S510", "a part of the analysis failed",
     "A solver, law or element reported that it can't continue. It may come from a plug-in.",
     "Read the text of the message, which comes from that solver, law or element. Use another --solver to see "
     "whether the solver is the reason."},
    {"S511", "the run was interrupted",
     "Ctrl-C, or a request of the system to end, stopped the run. All complete results are on disk. So is a "
     "checkpoint, if it could be written.",
     "The command sagefe run --restart continues from the checkpoint. If you gave several decks, repeat the "
     "command for those that had not started."},
    {"S512", "the process of a deck was killed",
     "With --jobs each deck has its own process, and this one was killed. The system was out of memory, a user "
     "ended the process, or the program has a fault.",
     "Run the deck alone to see whether it happens again. Fewer --jobs need less memory at a time. If the "
     "program has a fault, please report it together with the deck."},
    {"S513", "a fault of the program or of a library",
     "A library, or a check within the program, reported something that the program does not expect. The deck "
     "may be right.",
     "Try another solver (--solver) and one thread (--threads 1) to find the part with the fault. Please "
     "report it together with the deck, the command and the message."},
    {"S515", "the safety factor is not proved",
     "The search ended without the bracket that was requested. Either no factor is stable, or every factor is "
     "stable, or the upper end of the bracket does not prove a failure. In the last case sagefe found no "
     "equilibrium, but the ground does not continue to move. Perhaps only the iterations failed, and the soil "
     "did not.",
     "Read the reasons that sagefe prints for both ends, and change --smallest or --largest. For an end that "
     "is not proved, use more --iterations and --cuts, --from anew, or --dilation reduced with a dilation "
     "angle closer to the friction angle."},
    {"S520", "the initial stress is outside the yield surface",
     "At some points the initial stress exceeds the strength. In the first increment the excess is transferred "
     "to neighbouring points, so that the run starts from another state than the deck states.",
     "Lower the initial shear (K0 closer to 1) or raise the strength. If the change is acceptable, nothing "
     "needs to be done: the listing shows the stresses after the first increment."},
    {"S521", "displacements are beyond small strains",
     "The run assumes small strains and the initial geometry. Displacements of this size change the geometry, "
     "so that the results do not describe the real problem.",
     "Use the results up to a displacement of about a tenth of the size of the body. Or apply smaller loads, "
     "or run the deck with large strain (docs/manual/large_strain.md)."},
    {"S522", "points are at the apex or at the tension cut-off",
     "At these points the law has little or no shear strength. The stress there depends on how the law treats "
     "tension: return to the apex, cut-off or zero stress. The message counts each kind, and also the points "
     "whose tangent has no stiffness in any direction. Several states may be in equilibrium there.",
     "Find the points with --points. At a free surface they are mostly harmless. Compare with another tension "
     "cut-off or apex code."},
    {"S523", "the solution may not be unique",
     "At yielding points the determinant of the acoustic tensor is no longer positive, so that shear bands as "
     "wide as one element may form. If the strength of the law decreases with strain (softening), the peak "
     "load and all that follows depend on the mesh and the steps, and sagefe warns. If the flow is only "
     "non-associated (the dilation angle is below the friction angle), as in most sands, the message is a "
     "note, in the listing and with -v.",
     "Compare two meshes (--refine 1) and twice the increments. A computation with the dilation angle equal to "
     "the friction angle gives an upper limit of the load."},
    {"S524", "loads and reactions do not balance",
     "Loads and reactions of the whole model differ by more than rounding. The solution lost accuracy.",
     "Usual reasons are parts of very different stiffness and a Poisson's ratio close to 1/2: see S504 and "
     "S525. Compare with another solver."},
    {"S525", "the results have few accurate digits",
     "Very stiff parts are connected to very soft ones, or Poisson's ratio is very close to 1/2. Of 16 digits "
     "only a few are accurate. The message gives their number.",
     "Make stiff parts only 1e3 to 1e6 times as stiff as soft ones, and use a Poisson's ratio of 0.499 with "
     "b-bar. If four digits are enough, nothing needs to be done."},
    {"S526", "increments are too long for the law",
     "The stiffness of a law (hyperbolic, Cam clay) changes within an increment. sagefe divides the increment "
     "into up to 64 parts, and even these are too long to be accurate. Twice the increments would change the "
     "result by more than 1 percent.",
     "Use more increments in this stage. Compare with twice as many until the results do not change."},
    {"S527", "a part is held only by open interfaces",
     "All interfaces around the part are open, and only the small stiffness that is left in them determines "
     "its position. From then on the displacements of the part have no meaning.",
     "Hold the part by fixities, or use only the results before the interfaces opened."},
    {"S528", "the first stage does not start in equilibrium",
     "The initial stresses are not in equilibrium with the weights, loads and supports of the first stage. The "
     "difference is released in proportion over the increments of the stage, so that bodies move without a "
     "load.",
     "If this motion matters, correct the initial stress, K0 or the weights, or add the gravity or pressure "
     "that balances the stress. If there is no initial stress on purpose, nothing needs to be done."},
    {"S529", "seepage exits switch between two states",
     "An exit is a node where water may leave the soil. Either the head there is at its limit and water "
     "leaves, or the head is lower and no water flows. At the nodes of the message each state leads to the "
     "other, so that there is no solution.",
     "Use smaller elements near the end of the wet face. Remove exits that are known to stay dry."},
    {"S530", "the correct response of a triaxial report is not known",
     "A triaxial report compares the mesh with the correct response, that of a single point of the specimen's "
     "material. sagefe applies the strains of the mesh to this point. From the increment in the message on, "
     "the law found no state of the point, so that the columns of correct values and ratio are blank. Most "
     "often the strength decreases faster than the point unloads, or the cell pressure exceeds the strength.",
     "Use more increments, or a slower softening. The measured values do not depend on the correct response."},
    {"S531", "the specimen of a triaxial report is not uniform",
     "The correct test of a triaxial report is that of a single point, which starts from the stress and "
     "history of the specimen. Here the specimen is not uniform when the stage of the report begins, so that "
     "there is no such point.",
     "Start the report in a stage in which the specimen is still uniform, or use the ratio with caution."},
    {"S537", "a free surface is blurred",
     "Soil of the law darcy_free_surface loses its permeability over a range of pressure heads, the ramp. The "
     "default height of the ramp is the size of an element. Here the ramp covers a large part of all wet soil. "
     "The free surface lies somewhere within the ramp, and the discharge is as inaccurate as the position of "
     "the surface.",
     "Use smaller elements (--refine 1) or a smaller ramp in the material. Compare the discharges."},
    {"S538", "dry soil carries water",
     "Above the free surface the soil keeps a small part of its permeability, the parameter 'least', so that "
     "heads have values there. Here the flow above the surface is not negligible: much dry soil lies above "
     "little wet soil, or the parameter is too large.",
     "Use a smaller 'least' in the material (1e-4), or remove the soil that stays dry."},
    {"S539", "no free surface was found",
     "The search starts with a ramp (see S537) that is much higher than that of the material. It then reduces "
     "the ramp in steps, and starts each step from the heads of the previous one. At one of these steps sagefe "
     "found no heads.",
     "Use a larger ramp or a larger 'least' in the material, smaller elements, or more iterations in the "
     "stage. Check that water can leave the soil (exits, code 2)."},
    {"S540", "the flow has no stream function",
     "The stream function at a point is the flow between this point and a fixed one. It has a single value "
     "only if no water enters or leaves inside the flow. Around a well, a drain, a prescribed head inside, or "
     "a hole that accepts water, its value grows with each turn. The field is blank in that part of the flow.",
     "For the discharge, use a report of kind 4 with lines of nodes. For a picture, use --picture flow_net. "
     "Its stream lines have a jump along one line."},
    {"S541", "how sagefe computes pore pressure below a sloping phreatic line",
     "Below a level phreatic line the pore pressure is hydrostatic. In seepage along a slope the lines of "
     "equal head are at right angles to the slope. The pressure is then smaller by the factor cos^2 of the "
     "slope: 12 % less at 20 degrees. The note states which of the two rules the deck uses.",
     "Value 1 of the water card chooses the rule. 0 uses the vertical depth, which is on the safe side below a "
     "slope. 1 multiplies this depth by cos^2 of the slope of the line. Flow elements (kind 4) solve for the "
     "pressure instead."},
    {"S542", "an exit gradient without bound",
     "The velocity has no bound at a node where an impervious edge meets an edge with given heads at more than "
     "a right angle. The same holds where the edge of the flow turns inwards. The computed gradient grows with "
     "every refinement. In a report of a line through such a node the largest gradient is blank.",
     "End the line before that node. Judge the exit by the mean gradient over a relevant length (Terzaghi: "
     "half of the embedment), or by the seepage force on the soil there."},
    {"S550", "steps were found by dynamic relaxation",
     "The stage moves supports, and Newton's method found no equilibrium even with the shortest step. For "
     "these steps sagefe applied the motion elastically and then let the ground move until it came to rest. "
     "The state of rest is an equilibrium within the tolerance of the stage, and its history is that of this "
     "motion. If the flow is non-associated, there may be other equilibria.",
     "Nothing needs to be done. More increments, and a second mesh, show how much the answer depends on the "
     "load path. It depends less if the dilation angle is closer to the friction angle."},
    {"S551", "an element that is only for small strain",
     "Large strain computes every element at its present position. It accepts solid elements of few nodes "
     "without enhanced strain, interfaces with Gauss or Newton-Cotes points, and elements of contact. It "
     "rejects structures, flow elements and coupled elements.",
     "Use one of the elements or formulations that the message lists, or small strain."},
    {"S552", "a law that is only for small strain",
     "Large strain gives a law the Kirchhoff stress and increments of the elastic logarithmic strain. The law "
     "must be isotropic, and its stress must follow from an elastic strain. sagefe rejects laws that use "
     "increments of the total strain, and laws that change with point or stage.",
     "Use an isotropic elastic or elastic-plastic law, or small strain."},
    {"S553", "a part of the model that is only for small strain",
     "Pore water, stages that set displacements to zero, bounds and searches for a factor of safety assume "
     "that the model keeps its shape. They are not possible with large strain.",
     "Remove this part, or use small strain."},
    {"S554", "stresses and strains of a run with large strain",
     "Stresses are Cauchy stresses, which are forces per present area. Strains are logarithmic (Hencky) "
     "strains of the left stretch since the activation of the group. Edge pressures stay normal to the moved "
     "edge and act on its present length. Point forces and weights keep their direction and size.",
     "Nothing needs to be done. For nominal stresses (force per initial area) use the forces in the reports of "
     "nodes."},
    {"S555", "an element turns inside out",
     "In the step that failed, a point or a corner of the element moves through one of the element's sides. At "
     "large strain that happens often. For example, the free side of a specimen rolls onto a rough platen and "
     "folds the corner. The message names the element and the corner with the smallest remaining share of its "
     "initial area.",
     "If the steps were large, use smaller increments. A mesh with a cut or rounded corner, or with larger "
     "elements at the corner, allows more motion. If the side really rolls onto the platen, use elements of "
     "contact, which allow this."},
    {"S556", "contact needs large strain",
     "Elements of contact find the gap between an edge and a rigid line from their present positions. At small "
     "strain the bodies keep the shape and the place of the mesh.",
     "Turn large strain on, or use an interface of zero thickness."},
    {"S557", "a mesh with contact can't be refined",
     "An element of contact joins one edge and the two nodes of a rigid line. After a refinement, two such "
     "elements would need the same line.",
     "Write a deck with the finer mesh. Leave out options that refine, grade or coarsen the mesh, and "
     "--converge."},
    {"S558", "pressures and motion in the first stage of an initial stress",
     "sagefe releases the forces of an initial stress over its first stage, while the pressures of the stage "
     "grow and replace them. At large strain the pressures follow their edges, and those forces do not. If "
     "supports move in the same stage, the results before the end of the stage are not those of a body under "
     "its pressure. The path of a plastic law is then not correct either.",
     "Put the pressures into a first stage without motion, and move the supports in the stage after it."},
    {"S559", "the sides of an interface have slipped apart",
     "At large strain an interface follows the motion of its two sides, but it joins the same pairs of nodes "
     "as in the mesh. Where they slip by more than half of an element's length, the tractions act between "
     "parts that do not touch.",
     "Use longer elements along the interface, or elements of contact where one side is rigid "
     "(docs/manual/large_strain.md)."},
    {"S560", "an element of contact is not on the edge of a solid",
     "An element of contact must have all nodes of one whole edge of a solid element: both ends, then the "
     "middle node. Otherwise parts of the edge would pass through the rigid line without a force.",
     "Give the nodes of the edge that the message names. Edges of two nodes need contact4, edges of three "
     "contact5. Options that change the elements of the solids do not change contact."},
    {"S561", "the rigid line of contact has the wrong direction or no support",
     "Seen from the first node of the rigid line towards the second, the solid must be on the left. Supports "
     "must hold or move both nodes of the line.",
     "Exchange the two nodes, or add supports in x and y."},
    {"S570", "bounds need plane strain",
     "sagefe bounds solves limit analysis only in plane strain. Its upper field has no hoop strain and its "
     "lower field no hoop stress.",
     "Use sagefe run or sagefe safety for the axisymmetric model."},
    {"S571", "bounds can't contain structures",
     "The limit analysis of sagefe contains only soil and interfaces. Its stress field can't contain a bar, "
     "beam or spring.",
     "Remove the structure, apply its force to the ground as a pressure, or use sagefe safety, which accepts "
     "structures."},
    {"S572", "the law has no bounds",
     "The theorems of limit analysis need a convex yield condition that does not change. sagefe bounds accepts "
     "Mohr-Coulomb, Tresca (phi = 0) and Drucker-Prager without tension cut-off for soil, and cohesion with "
     "friction for interfaces.",
     "Replace the material by mohr_coulomb with its strength at failure."},
    {"S573", "the load does not act on sides of elements",
     "A stress field can carry tractions on sides of elements, but not a force or a prescribed displacement at "
     "one point. Near such a point the ground yields at any load.",
     "Use a pressure card, forces on all nodes of the loaded sides, or prescribed displacements of whole "
     "sides."},
    {"S574", "there is nothing to bound",
     "The chosen stage does not exist, has no soil, or adds no load that a factor could multiply.",
     "Choose another stage with --stage, or compute bounds of the factor of safety with --of strength."},
    {"S575", "a bound was not found",
     "One of the two optimisations ended without a field that passed its check: equilibrium and yield for the "
     "lower field, the flow rule for the upper field. The message gives the reason.",
     "A load has bounds only if the ground is stable under the fixed loads alone. If it is not, use --of "
     "strength for the factor of safety. If the optimisation ended early, try another mesh (--elements, "
     "--refine)."},
    {"S576", "the mesh does not suit bounds",
     "Both fields need a mesh whose elements meet along whole sides, and interfaces with soil on both sides.",
     "Divide the elements so that no node lies within a side of another element. Give an interface soil on "
     "both sides, and common nodes in place of an interface elsewhere."},
    {"S577", "bounds can't use these pore pressures",
     "Bounds need known pore pressures: lines, r_u, values at nodes, or heads of flow elements at the start of "
     "the stage. The pressures of elements that solve for pore water depend on the load path.",
     "Correct the earlier stages, or give the pressures at nodes. For a model with consolidation, use "
     "undrained strengths instead."},
    {"S578", "finite elements contradict the bounds",
     "With equal dilation and friction angles, the search for a factor of safety found no equilibrium below "
     "the lower bound. But the stress field of that bound is in equilibrium. One of the two results is wrong.",
     "Search with more iterations: sagefe safety DECK --iterations 200. Compare the loads and supports of both "
     "computations."},
    {"S579", "fields of a consolidation stage do not fit",
     "The fields time_error, end_degree, end_pressure and output_times need pore_water 2, and values in their "
     "range. With time_error, theta must be blank. A stage that ends by degree or pressure can't change a "
     "load, support or group, because such changes need the whole duration. The history of a support or load "
     "of excess_pressure consists of pairs of a time and a share of the value, in ascending order of time.",
     "Correct the field. A load that changes needs a stage of its own, before the stage that waits for the "
     "consolidation (docs/manual/consolidation.md)."},
    {"S580", "how a stage of consolidation ended",
     "A stage with end_degree or end_pressure ends after the first step that reaches this degree or pressure. "
     "The message is a warning if the duration ended first.",
     "If the duration was too short, make it longer."},
    {"S581", "a load cannot be controlled by that displacement",
     "The field load_control of a stage names one or two nodes, a direction and a growth. It is possible only "
     "in the last stage, with Newton's method and small strain. That stage must have loads and no prescribed "
     "displacements, and the model must solve for displacements only.",
     "Correct the field as the message states (docs/manual/stages.md)."},
    {"S582", "the displacement that controls the load is not free",
     "All nodes of load_control are supported in that direction, or belong to no active element.",
     "Name a node that the load can move."},
    {"S583", "safety with a load that is controlled by a displacement",
     "Strength reduction needs loads that are known. The load of a stage with load_control is an unknown.",
     "Remove load_control from the stage, and give the load for which you need the factor of safety."},
    {"S584", "the displacement that controls the load cannot grow further",
     "sagefe found no equilibrium with a larger value of the displacement. The usual reason is a snap-back: "
     "after the peak, load and displacement decrease together. The soil beside a thin softening band is "
     "unloaded, and springs back by more than the band yields.",
     "Control the load by a displacement that grows throughout, such as the difference of two nodes on "
     "opposite sides of the band. A larger softening strain or a larger band width removes the snap-back."},
    {"S585", "initial stresses raise the preconsolidation pressure",
     "At some points the initial stress lies outside the yield surface that belongs to the given "
     "preconsolidation pressure. There sagefe enlarges the surface so that it passes through the stress: the "
     "soil is normally consolidated.",
     "Compare p_c with the initial stress. If you give the parameter ocr or pop of the law in place of p_c, "
     "sagefe computes p_c from the initial stress."},
    {"S586", "a group of soil lacks an initial stress that its law needs",
     "Stiffness and strength of the law increase with the mean stress. Without stress the law has neither.",
     "Give an initial card of kind 0 or 1 for the group. If a stage activates the group, the initial card "
     "belongs to the cards of that stage."},
    {"S587", "a note about a law",
     "The note describes a property of the law, such as a stiffness that does not follow from an energy.",
     "Nothing needs to be done. docs/theory has the page of the law."},
    {"S590", "a card could not be aligned and is unchanged",
     "sagefe align moves values that are outside of their columns. For this card no set of fields fits the "
     "values, or several sets fit.",
     "Write 0 for each blank field of the card, or move the values by hand. The command sagefe echo shows the "
     "columns."},

    // S6: results, checkpoints and what is made of them.
    {"S591", "a table of time of a load or displacement does not fit",
     "The field history of a load, a pressure or a displacement has pairs of a time and a factor. Times count "
     "from the start of the stage, ascend and end within its duration. The factor at time 0 is 0. Pressures on "
     "structures, and pressures at large strain, cannot follow a table.",
     "Correct the table. A load that acts at once needs a stage of its own (docs/manual/stages.md)."},
    {"S600", "the error of the time steps",
     "A stage with time_error chooses its steps by a bound on the error of each step. Errors decay as the "
     "pressures do, so that the sum of these bounds is a bound on the error at every time of the stage. This "
     "is proven for "
     "elastic soil; for other laws it is an estimate.",
     "Nothing needs to be done. A smaller time_error gives a smaller sum, with more steps."},
    {"S601", "a result can't be written",
     "The disk is full, the user may not write to the folder, or a folder or a device has that name. The "
     "message gives the system's reason.",
     "Free space or choose another folder (-o). sagefe run --restart continues from the last checkpoint."},
    {"S602", "a result would replace another file",
     "The output file is one that the same command reads, or two results would have the same name. Results "
     "have the name of the deck's folder or file.",
     "Choose another output folder (-o) or another name. Run decks of the same name in separate commands with "
     "different output folders."},
    {"S603", "another run is writing there",
     "A run locks the names of its results. Another process, perhaps in the background, uses the same output "
     "folder and deck name.",
     "Wait until that process ends, stop it, or choose another folder (-o). The lock disappears with its "
     "process, also after a crash."},
    {"S604", "the picture can't be converted",
     "The program rsvg-convert, which makes PDF and PNG from SVG, is missing or failed.",
     "Install librsvg2-bin, or use --format svg."},
    {"S605", "the library of result files crashed",
     "HDF5 crashes if it can't allocate memory, as under a limit on memory (ulimit -v, ulimit -d). For this "
     "reason sagefe writes with HDF5 in a separate process. The run continues without the result file.",
     "Raise the limit, or run without --result. --vtu needs less memory."},
    {"S606", "a cell of a table is not a number",
     "A column of the plot has words, nan or inf in some rows. Either the file is damaged, or these cells have "
     "no number on purpose.",
     "Look at the line that the message names. If it should have a number there, write the table again."},
    {"S607", "a curve of sagefe drive ends early",
     "The law found no state for the next step, or the test is impossible with these parameters. The table and "
     "the plot contain the steps before this one. The exit code is 3.",
     "The message gives the step and the reason. Smaller steps (--steps) or a shorter path (--to) may help."},
    {"S608", "the list of an earlier run's files is damaged",
     "A run uses the file STEM.files to remove the results of an earlier run of the same name. That file was "
     "cut short or changed, so files of the earlier run may remain beside the new ones.",
     "Remove the files that the message names if you do not need them."},
    {"S609", "a table may be cut short",
     "The last line of a table does not end in a line break. The file was copied or written only in part.",
     "Copy it again, or run the deck again."},
    {"S610", "a requested field is in none of the outputs",
     "The field has values at nodes or at integration points, and no output of this run shows such values.",
     "Add --nodes, --points or --result, or remove the field from --field."},
    {"S611", "a law can't vary with place or stage as requested",
     "A parameter that grows with depth leaves the range of its law somewhere in the group. Or a law with many "
     "history variables replaces another law. Or the law is a user routine that sets its own initial values.",
     "Change the growth or the level, so that the parameter is within its range in the whole group. In the "
     "other cases use one law for the whole group and all stages."},
    {"S612", "the stress lies outside the yield surface of a new law",
     "A group continues with another material, which can't carry the present stress. At the start of the stage "
     "the stress of such points returns to the yield surface of the new law. The forces that become unbalanced "
     "are released during the stage.",
     "Check the displacements of the stage. If the stress should be possible, correct the strength."},
    {"S613", "a node without support during lock-off",
     "Lock-off stresses an anchor or strut to a given force. In the stage of lock-off this force is constant, "
     "so that the bar has no stiffness that could hold the node.",
     "Support the node at the far end of the bar, or make the free length of the anchor one element."},
    {"S614", "a card that changes the law of a group does not fit",
     "The card breaks one of these rules. Lock-off is only for bars and springs, in a stage. Another material "
     "must have a law for the same kind of element. A parameter must belong to the law. The group must be "
     "active in the stage.",
     "Correct the card. The command sagefe list materials shows laws and their parameters."},
    {"S615", "the unit weight does not change with the material",
     "A group that continues with another material keeps its initial weight.",
     "Give both materials the same unit weight, or add the difference as a load."},
    {"S616", "a prescribed displacement has no factor of safety",
     "The stage moves supports. Their force on the ground is never more than the ground can carry. With less "
     "strength this force is smaller, so that the ground never fails and a factor of safety has no meaning.",
     "Compute bounds of the force with --of load, or choose a stage with loads by --stage."},
    {"S617", "the value can't differ from place to place",
     "A random field gives each point its own value of a parameter of a law. This is possible in solids, "
     "interfaces and bars. Loads, unit weights and flow elements can't have one.",
     "Remove correlation_length, or name a parameter: material.NAME.PARAMETER (sagefe list materials)."},
    {"S620", "sagefe report found no result file",
     "A report page needs the result file of a run, STEM.h5, with the tables and the listing beside it. sagefe "
     "run writes a result file only if an option requests it.",
     "Run the deck with sagefe run DECK --report, which also writes the page, or with --result. Then give "
     "sagefe report the name of the result file."},
    {"S621", "a page omits something for lack of space",
     "A report page contains its data, and should be small enough to send and to open quickly: about 4 MB for "
     "each run. The message and the page list the fields, states or rows that are left out.",
     "The option --size MB of sagefe report gives the page more space. --field NAME chooses the fields that it "
     "keeps."},
    {"S622", "no run of the page has the field",
     "No run has a field of this name at nodes or integration points. Or the name is that of a field that the "
     "page derives from the stress by itself (mean, deviator, principal stresses).",
     "Use a name from the list in the message. stress, strain and displacement contain all their components."},
    {"S625", "the law is not for rotational springs",
     "The stiffness of a rotational spring is a moment per radian, the bending_stiffness of its law. This law "
     "computes its bending stiffness from a modulus and a thickness.",
     "Give the spring a material of its own, with the law section_elastic or section_plastic "
     "(docs/manual/structures.md)."},
    {"S626", "a rotational spring has no effect",
     "A rotational spring joins the two unknowns rotation and hinge_rotation of its node. One of them is used "
     "by no beam and no support there. The spring then rotates freely and has no moment.",
     "Let one beam at the node start with a hinge, and another one end there without a hinge. Or hold the "
     "rotation of the node by a fixity card: the spring is then an elastic support."},
    {"S630", "the checkpoint does not fit",
     "The checkpoint belongs to another deck, other options, other outputs or another build of sagefe. Or "
     "files that the run would continue have changed since. sagefe does not continue, because that would mix "
     "two runs.",
     "Run the deck again without --restart, or restore the deck, the options and the program."},
    {"S631", "the checkpoint can't be read", "The file is damaged, cut short or not a checkpoint.",
     "Run the deck again without --restart."},
    {"S632", "how a run continues from an earlier one",
     "The note gives one of these facts. There was no checkpoint, so the run starts from the beginning. Or "
     "files contained bytes that were written after the checkpoint, and sagefe removes these and computes them "
     "again. Or a file of an earlier run has changed since, and sagefe does not remove it.",
     "Nothing needs to be done: the results are those of a run without interruption. Remove the remaining file "
     "if it is not needed."},
    {"S633", "an interrupted run could not stop by itself",
     "Ten seconds after Ctrl-C, or after a request of the system to end, the program had not stopped. A user "
     "routine, or the reading or writing of a file, did not return. The program then ended itself with exit "
     "code 5.",
     "Look for an endless loop in the user routine, or for a pipe (FIFO) that no process reads or writes. The "
     "command sagefe run --restart continues from the last checkpoint, if there is one."},
    {"S635", "the cut of a section meets no solid",
     "The straight line between the two ends of the cut crosses no element of the solids, or of the chosen "
     "group. The usual reasons are units (mm for m) and exchanged coordinates.",
     "Correct the ends of the cut or the group. Parts of a cut outside of the solids are allowed and add "
     "nothing to the forces."},
    {"S636", "a section can't be computed",
     "The cut has no length or lies on the axis of symmetry, the chosen group has no solids, solids lie on one "
     "another, or the model has large strains.",
     "Correct the two ends of the cut or the group: docs/manual/structures.md, sections through solids."},
    {"S637", "the group of a section is divided",
     "An initial stress in horizontal layers (start_stress) makes sagefe divide groups into layers. The group "
     "that the report names is then only one layer of the group in the deck.",
     "Remove the group from the report. Choose the two ends of the cut so that it ends where the group ends."},
    {"S638", "a section shows no forces",
     "The solids that the cut crosses are not active in any stage of the report.",
     "Let the report start in another stage, or correct the cut."},
    {"S640", "a result file can't be used",
     "The file is not a result file of sagefe or is damaged. Or it was written by a version of sagefe that "
     "builds another model from the same deck.",
     "The command sagefe run DECK --result writes it again. sagefe plot needs the file STEM.h5."},
    {"S641", "a table can't be read",
     "A CSV table needs a line with the names of its columns, and as many cells in each line as there are "
     "names.",
     "Use the tables as sagefe wrote them. A spreadsheet must save them with commas between cells and points "
     "in numbers."},
    {"S642", "a column is not in the table",
     "--xy names columns of the tables. None of the given tables has this one.",
     "Use a name from the list in the message. The command head -1 TABLE also shows the names."},
    {"S643", "the result file has no such state",
     "The option --at of sagefe plot names a stage and increment, strain or load factor that the run did not "
     "write. Or --states of sagefe run names a state at which no increment ends, and sagefe wrote the nearest "
     "state.",
     "Use a state from the list in the message, or write this state with sagefe run --result --states."},
    {"S644", "a field is unknown or can't be drawn",
     "The command sagefe list fields shows the names of fields. History variables have the names of the laws "
     "in the deck. A picture needs a field at nodes or integration points that some element of the deck has.",
     "Use a name from the list in the message."},
    {"S645", "there is nothing to plot",
     "The model has no interface, the line crosses no element, or no field was named.",
     "Name a field. Compare the coordinates of the line with those of the mesh."},
    {"S646", "units differ",
     "Two runs, or two columns, have different units. They can't be compared on one axis or scale.",
     "Draw them in separate files, or write one of the decks in the units of the other."},
    {"S650", "a path or test can't be followed as given",
     "The columns of a path file must be components of the stress or the strain of the law. Give one of the "
     "two for each component, with a number in each cell.",
     "Correct the file. docs/manual/drive.md lists the columns. A blank cell does not mean zero in a column "
     "that controls the path."},
    {"S651", "the law for sagefe drive is incomplete",
     "A law needs its name and its parameters by name. One of them is missing, is misspelt, or has no number.",
     "The command sagefe list materials shows names and parameters. Give each parameter with --set NAME=VALUE, "
     "or use those of a deck with --deck."},
    {"S660", "the fit can't be computed from these data",
     "A fit needs free parameters of the law, bounds around their starting values, and measured curves. The "
     "first column of each curve is the quantity that the test prescribes. The curves need more points than "
     "there are free parameters.",
     "Correct what the message names. docs/manual/drive.md shows the columns of a curve and the form --free "
     "NAME=LOW:HIGH."},

    // S7: decks of other programs, meshes, and writing for others.
    {"S701", "the deck's own counts and lists contradict each other",
     "A deck of another program describes its mesh by counts and lists (columns and rows, coordinates, "
     "materials of elements). These do not agree with each other, or describe an impossible body.",
     "Correct the list that the message shows. The command sagefe echo DECK prints each value with its name."},
    {"S702", "a feature of that program is not translated",
     "The deck of another program uses a generation of cards, inclined supports or options that sagefe reads "
     "but does not translate.",
     "Replace the feature in the deck. For example, write out each of the cards that the original program "
     "would generate."},
    {"S703", "a law of another program is replaced",
     "The deck's soil law has no exact counterpart. The message names the law that replaces it and what is "
     "missing.",
     "Check the parameters of the new law on the converted deck (sagefe convert DECK own.dat). Choose another "
     "law there if needed."},
    {"S704", "a mesh was translated with a change",
     "sagefe reversed elements, turned degenerate ones into triangles, omitted nodes without elements, or "
     "replaced a boundary without a counterpart by a support.",
     "Look at the picture of the mesh. If the message describes what is meant, nothing needs to be done."},
    {"S705", "load factors of another program",
     "sagefe applies the load factors or a method of the other program in a different way than their name "
     "suggests. The message explains how.",
     "Compare the loads of each stage in the listing with the loads that you expect from the deck."},
    {"S710", "a mesh file can't be read",
     "The file is neither a Gmsh mesh of version 4.1 or 2.2 nor an input of Abaqus or CalculiX. Or it is cut "
     "short, or has elements or keywords that sagefe does not support.",
     "Correct the line that the message names. In Gmsh, save triangles or quadrilaterals with "
     "Mesh.MshFileVersion = 4.1. In an .inp file, write the nodes and elements themselves in place of *INCLUDE "
     "and of keywords that generate them."},
    {"S711", "the mesh holds no surface",
     "The file has only curves and points. Either only curves have physical groups, or the mesh was not made "
     "in two dimensions.",
     "Mesh in two dimensions. Give the surfaces a physical group, or save all elements (Mesh.SaveAll = 1)."},
    {"S712", "a material constant for the mesh is out of range",
     "A mesh has no material, so options of sagefe convert give its constants. The value of one of them is "
     "impossible.",
     "Young's modulus (--young) must be positive. Poisson's ratio (--poisson) must lie between -1 and 0.5."},
    {"S713", "a part of the mesh is left out",
     "Options of sagefe convert, or the names of curves, turn curves of the mesh into supports, pressures, "
     "structures and water lines. This name has no such meaning, or the curve lies on no element. sagefe also "
     "omits elements of other types, and keywords other than nodes, elements, sets and surfaces.",
     "Use the curve with --fix, --pressure, --beam, --bar or --water of sagefe convert. Or name it fix_x, "
     "fix_y, fix_xy or pressure=VALUE in the mesh."},
    {"S714", "the two sides of an interface do not match",
     "Lines named interface_bottom=NAME and interface_top=NAME are the two sides of one interface. Each line "
     "needs a partner at the same place with as many nodes, and each side needs its own nodes.",
     "Mesh both sides alike: use the same transfinite numbers, or make one curve periodic to the other. Gmsh's "
     "plugin Crack makes separate nodes from one curve."},
    {"S720", "something is left out of the written file",
     "The file format can't hold some data of the model, or holds numbers with fewer digits. The new file "
     "describes another problem, or the same problem less accurately.",
     "If these data matter, add them by hand in the other program. Or convert to .dat, which keeps most."},
    {"S721", "a choice is left to the other program",
     "The program that reads the file chooses the integration, the solver or the control of the iterations. "
     "Its results can differ slightly.",
     "Nothing needs to be done. To compare results digit by digit, use elements that both programs integrate "
     "in the same way (reduced 8-node elements)."},
    {"S722", "the model does not fit sage1 cards",
     "An element has more nodes, or a number more digits, than the columns of a card can hold.",
     "Convert to .msh or .inp, or write the numbers with fewer digits."},
    {"S723", "the other program would overwrite a file",
     "CalculiX gives its results the name of its input file, and a file of that name exists.",
     "Convert to the name in the message."},
    // S73: models with other values, from Python and in sweeps.
    {"S730", "the model has no number of that name",
     "A number of the model has a name that is made from the deck's materials, stages and reports and from the "
     "parameters of its laws. A sweep or a Python program uses a name that this deck does not have.",
     "Use the name that the message proposes. docs/manual/python.md explains the names, and Model.names() "
     "lists those of a deck."},
    {"S731", "the value does not suit the name",
     "A number of the model needs a finite value, or an integer if it is a count. Some names accept only one "
     "of a few words.",
     "Give a value of the kind that the message names."},
    {"S732", "the study file of a sweep can't be used",
     "The TOML file of the study has a mistake at the given line, has an unknown key, or lacks a key.",
     "docs/manual/sweep.md shows what a study contains."},
    {"S733", "a law written in Python raised an exception",
     "The Python function of the law raised an exception, or did not return stress, tangent and history of the "
     "right shapes. A Python program that calls sagefe receives the original exception.",
     "Correct the function. Law(NAME).drive() calls it without a mesh."},
    {"S734", "a name in a sweep has no effect on the deck",
     "The deck has no quantity or number of this name, or no value of it changes the model. An example is a "
     "parameter of a material that no group has. Every case would have the same result.",
     "Use the name that the message proposes, or remove the name from the study."},
    {"S737", "a tool that starts the parts of a sweep is missing or failed",
     "The option --parallel needs the program GNU parallel, and --slurm needs sbatch. If only some parts of "
     "the sweep failed, the process that merges the table computes the remaining cases.",
     "Install the tool, or omit the option. The logs in the output folder give details."},
    {"S738", "another sweep works on this study",
     "Another process computes the same study in the same output folder. Both would write the file of finished "
     "cases.",
     "Wait until that process ends, or choose another folder with -o."},
    {"S739", "a named part of the mesh does not fit its option",
     "An option of sagefe convert names a curve, point or set that the mesh lacks, or that does not fit the "
     "option. A force needs one node. A structure and a pressure need lines. A water line needs one height for "
     "each x.",
     "Use one of the names that the message lists, or another option."},
    {"S741", "partial factors are applied",
     "--factors multiplies the loads of the deck and divides its strengths. The note lists the factors. The "
     "result files of one set contain section forces as computed. The table of all sets contains design "
     "values: the section forces multiplied by the factor on effects.",
     "If that is meant, nothing needs to be done. The option --variable N names the stages whose loads are "
     "variable."},
    {"S742", "the sets of partial factors do not fit",
     "The command computes one set at a time, and --factors gives several. Or --variable or --structural names "
     "a stage that the deck lacks.",
     "Give one set, or the number of a stage of the deck. The commands sagefe run and sagefe safety accept "
     "several sets."},
    {"S743", "partial factors leave a strength undivided",
     "The set of --factors divides tan(phi), c or c_u. The law of a listed material has a strength, but no "
     "parameter that sagefe divides, for example M of modified_cam_clay. The results of its groups are those "
     "of "
     "the characteristic strength.",
     "Enter the design strength on the material card (for example a smaller M), or use a law with c and phi."},

    // S8: pieces from outside of the program.
    {"S801", "the deck needs a plug-in that is not loaded",
     "A line \"* plugin: NAME\" before the first card names a plug-in that the deck needs. A deck never loads "
     "a library by itself, because the user decides whose code the computer executes.",
     "Give --plugin LIBRARY with the library that has this name. The command sagefe list plugins --plugin "
     "LIBRARY shows the name and the content of a library."},
    {"S802", "a library can't be used as a plug-in",
     "The file is not a library, lacks another library that it needs, or has no entry point sage_plugin_v1. Or "
     "another compiler, or another version of sagefe, was used to build it: the message names the difference. "
     "Or the library crashed or failed when sagefe read its content.",
     "Build the library against the installed package of sagefe (sage_add_plugin in CMake, "
     "docs/manual/plugins.md) with the compiler that the message names. The command ldd LIBRARY shows other "
     "libraries that are missing, and sagefe conform LIBRARY tests the content."},
    {"S803", "a code or name of a plug-in is already used",
     "A law, element, solver or field of a plug-in has a code or name that the program or another plug-in "
     "already uses. A card could mean either.",
     "Change the code or name in one of the two plug-ins. Codes from 1000 upwards are free. Each author should "
     "use a separate range of codes."},
    {"S804", "the routine of a UMAT was not found",
     "A material with the law umat has no routine. Or sagefe can't load the library of --umat, or the library "
     "has no symbol umat_, umat or UMAT.",
     "Give --umat LIBRARY for all such materials, or --umat MATERIAL=LIBRARY for one. LIBRARY:SYMBOL names a "
     "routine with another name (the command nm -D LIBRARY lists the names). A Fortran routine becomes a "
     "library with gfortran -shared -fPIC."},
    {"S805", "a number of a umat material does not fit",
     "The material card of a UMAT begins with four numbers: stress components (4 or 6), state variables, "
     "symmetric (0, 1 or 2), and safe for threads (0 or 1). The routine's own properties follow.",
     "Compare the card with the documentation of the routine: NTENS is the number of stress components, NSTATV "
     "that of state variables (DEPVAR in an Abaqus deck), and PROPS are the properties."},
    {"S806", "a UMAT broke its rules",
     "The routine wrote beyond one of its arrays, ended the program (XIT, STOP, exit), or returned a value "
     "that is not a number. Or it returned an unsymmetric matrix although the card declares it symmetric. "
     "sagefe discards that step.",
     "The command sagefe conform --umat LIBRARY calls the routine without a mesh and reports its faults. Most "
     "often a routine writes beyond an array because the card has too few state variables or properties."},
    {"S807", "sagefe new can't write its file or folder",
     "The file exists, the folder is not empty, or the templates of sagefe new are not where they were "
     "installed.",
     "Choose another name or folder, or empty the folder. If the templates are missing, install the program "
     "again."},
    {"S808", "the test program of sagefe conform is missing",
     "sagefe conform runs a second program, which is built only if GoogleTest is installed.",
     "Install GoogleTest (libgtest-dev), then build and install the program again."},
    {"S809", "a user material printed something, or needs attention",
     "A UMAT wrote text, called a function that sagefe does not offer, or returned a DDSDDE that is not the "
     "derivative of its stress. The run continued. Routines often print text in states for which they were not "
     "written, or to help their authors find errors.",
     "Read the log that the message names. Remove statements that print at every point, because they slow a "
     "run down. If convergence is slow, give symmetric = 2 on the card: sagefe then computes the tangent from "
     "differences of the stress, and not from DDSDDE (docs/manual/umat.md)."},
    {"S810", "a law or element crashed in sagefe conform",
     "A law or element of the library caused a crash of the program that tests it. Most often it read or wrote "
     "beyond an array, or divided integers by zero.",
     "The last line above the message names the test. Build the library with -g -fsanitize=address, or run "
     "sagefe conform LIBRARY under gdb or valgrind. These show the line of the fault."},

    // S9: the command line.
    {"S901", "there is no such command", "The first word after sagefe must be the name of a command.",
     "The command sagefe --help lists the commands. The usual one is sagefe run DECK."},
    {"S902", "an option or word is unknown",
     "The command has no such option, or accepts no further word here. Each command has its own options.",
     "See sagefe COMMAND --help, or man sagefe-COMMAND."},
    {"S903", "something is missing on the command line",
     "The command needs a deck, a file or the value of an option.",
     "The command sagefe COMMAND --help shows the order. Words in brackets are optional."},
    {"S904", "an option's value is rejected",
     "The value is unknown, is not a number, is out of range, or names a file that does not exist.",
     "Give a value of the kind that the message names. A value with blanks needs quotes."},
    {"S905", "options do not go together", "Two options exclude each other, or one needs another.",
     "Give one of them, or both that belong together. The help of the command explains which."},
    {"S906", "a warning counts as an error",
     "With --strict, warnings count as errors, and the deck or its run has warnings. If the deck has warnings, "
     "sagefe does not run it. If the run has warnings, its results are complete. The exit code is 2.",
     "Correct what the warnings describe, or omit --strict."},
    {"S907", "the command needs what the deck lacks",
     "--converge and --follow need numbers of reports, and the deck has none, or none with a value at the end "
     "of the run. Or a point of sagefe compare lies outside of both meshes.",
     "Add a report card, name a report that the message lists, or give a point inside the mesh."},
    {"S908", "this command can't read the deck from a pipe",
     "The command reads its deck more than once. A pipe can be read only once.",
     "Save the deck to a file first."},
    {"S909", "an option does nothing here",
     "Another option makes this one ineffective. For example, --converge writes its table and the reports, "
     "and no other files of a run.",
     "Omit the option. After --converge, a line of the table gives the options of a run with the mesh of that "
     "line."},
    {"S910", "there is no such code",
     "The command sagefe explain needs a code as messages print it in brackets, such as S501.",
     "The command sagefe explain lists all codes. sagefe explain --search WORD lists those whose texts contain "
     "the word."},
    {"S911", "standard output was lost",
     "The program that read the output ended, or the disk of the output file is full. Results in files are not "
     "affected.",
     "Write the output to a file on a disk with enough space (> FILE), and read this file with less."},
    {"S912", "the program of a command is missing",
     "The commands sagefe figures, stress and verify start the programs sagefe-figures, sagefe-stress and "
     "sagefe-verify, which must be in the folder of sagefe. A build without studies has none of them.",
     "Build them by cmake with -DSAGE_STUDIES=ON. scripts/test also builds them (docs/manual/verify.md)."},
};

}  // namespace

std::span<const MessageEntry> messages() {
  return kMessages;
}

const MessageEntry* find_message(int number) {
  const auto* found =
      std::ranges::find(kMessages, number, [](const MessageEntry& m) { return m.code.number(); });
  return found != std::end(kMessages) ? found : nullptr;
}

const char* section_of(const MessageEntry& message) {
  return kSections[message.code.number() / 100 - 1];
}

}  // namespace sage
