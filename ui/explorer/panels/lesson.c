// The strip of a lesson below the title: the task, or its result.
#include "ui/explorer/panels/panel.h"

enum { MOST_LINES = 7 };

// The step as text: its sentence, the answers to choose from, what it says when it is
// done.
static void write_step(const explorer_model *model, char *text, size_t size)
{
    const lesson_step *step = &model->session.base.lesson.steps[model->lesson.step];
    if (model->lesson.passed) {
        snprintf(text, size, "Right. %s", step->then);
        return;
    }
    snprintf(text, size, "%s", step->say);
    for (int i = 0; i < step->choice_count; i++) {
        text_add(text, size, "  %d: %s", i + 1, step->choices[i]);
    }
}

// The key to press.
static const char *wanted_key(const explorer_model *model)
{
    const lesson_step *step = &model->session.base.lesson.steps[model->lesson.step];
    const bool answers = step->check == LESSON_NUMBER || step->check == LESSON_CHOICE;
    if (model->lesson.passed || step->check == LESSON_READ) {
        return "y goes on";
    }
    if (answers) {
        return "A answers, y asks for a hint";
    }
    return "do it, y asks for a hint";
}

static int rows(const explorer_model *model, const explorer_view *view, screen_size body)
{
    (void)view;
    char text[1024];
    text_line lines[MOST_LINES];
    if (!model->lesson.on) {
        return 0;
    }
    write_step(model, text, sizeof text);
    const int count = text_wrap(text, body.width - 4, lines, MOST_LINES, NULL);
    return count + 2;
}

static void draw(const explorer_model *model, const explorer_view *view, layout *lay,
                 screen *s, area a)
{
    (void)view;
    (void)lay;
    const lesson *l = &model->session.base.lesson;
    char text[1024], title[LINE_TEXT];
    text_line lines[MOST_LINES];

    // the title shows the progress of the lesson and how to continue
    write_step(model, text, sizeof text);
    snprintf(title, sizeof title, "lesson, step %d of %d (%s)", model->lesson.step + 1,
             l->step_count, wanted_key(model));
    screen_frame(s, a.x, a.y, a.width, a.height, INK_EVENT, title);

    // as many lines as there is room for
    const int count = text_wrap(text, a.width - 4, lines, MOST_LINES, NULL);
    for (int i = 0; i < count && i < a.height - 2; i++) {
        screen_print(s, a.x + 2, a.y + 1 + i, a.width - 4,
                     model->lesson.passed ? INK_TITLE : INK_TEXT, "%.*s", lines[i].bytes,
                     lines[i].start);
    }
}

const panel lesson_panel = {.name = "lesson", .rows = rows, .draw = draw};
