// The strip of a lesson below the title: the task, or its result.
#include "ui/explorer/panels/panel.h"

enum { STEP_LINES = 7, STEP_TEXT = 1024 }; // at most

// The step of the lesson at which its reader is.
static const lesson_step *step_of_lesson(const explorer_model *model)
{
    return &model->session.base.lesson.steps[model->lesson.step];
}

// The step as text: its sentence, the answers to choose from, what it says when it is
// done.
static void write_lesson_step(const explorer_model *model, char text[STEP_TEXT])
{
    const lesson_step *step = step_of_lesson(model);
    if (model->lesson.passed) {
        snprintf(text, STEP_TEXT, "Right. %s", step->then);
        return;
    }
    snprintf(text, STEP_TEXT, "%s", step->say);
    for (int i = 0; i < step->choice_count; i++) {
        text_add(text, STEP_TEXT, "  %d: %s", i + 1, step->choices[i]);
    }
}

// The key to press.
static const char *wanted_key(const explorer_model *model)
{
    const lesson_step *step = step_of_lesson(model);
    if (model->lesson.passed || step->check == LESSON_READ) {
        return "y goes on";
    }
    if (step->check == LESSON_NUMBER || step->check == LESSON_CHOICE) {
        return "A answers, y asks for a hint";
    }
    return "do it, y asks for a hint";
}

// As many rows as the step takes at this width, in a frame; none without a lesson.
static int lesson_rows(const explorer_model *model, const explorer_view *view,
                       screen_size body)
{
    (void)view;
    char text[STEP_TEXT];
    text_line lines[STEP_LINES];
    if (!model->lesson.on) {
        return 0;
    }
    write_lesson_step(model, text);
    return 2 + text_wrap(text, body.width - 4, lines, STEP_LINES, NULL);
}

// The step in a frame whose title says how far the lesson is.
static void draw_lesson(const explorer_model *model, const explorer_view *view,
                        layout *lay, screen *s, area a)
{
    (void)view;
    (void)lay;
    char text[STEP_TEXT], title[LINE_TEXT];
    text_line lines[STEP_LINES];

    // the title shows the progress of the lesson and how to continue
    snprintf(title, sizeof title, "lesson, step %d of %d (%s)", model->lesson.step + 1,
             model->session.base.lesson.step_count, wanted_key(model));
    area_frame(s, a, INK_EVENT, title);

    // as many lines as there is room for
    const area inside = area_inside(a);
    write_lesson_step(model, text);
    const int count = text_wrap(text, inside.width, lines, STEP_LINES, NULL);
    const ink shade = model->lesson.passed ? INK_TITLE : INK_TEXT;
    area_lines(s, inside, shade, lines, count);
}

const panel lesson_panel = {.name = "lesson", .rows = lesson_rows, .draw = draw_lesson};
